# Thin verbs over CMake, ctest and tools/. `make help` lists them.
#
# `make demo` and `make test` need nothing but a Debian 12 machine: set-up installs what is missing first.

PROGRAM := build/release/boxwood

.PHONY: help setup build demo test wheel test-python test-arm test-wasm check fuzz bench microbench format docs clean
.DEFAULT_GOAL := help

help:    ## This list.
	@sed -n 's/^\([a-z-]*\): .*## \(.*\)/  make \1\t\2/p' Makefile | expand -t 19

setup:   ## Install the Debian packages that are missing; nothing when none are.
	@tools/setup.sh

build: setup  ## Build the program: build/release/boxwood.
	cmake --preset release
	cmake --build --preset release --target boxwood_program

demo: build  ## Render the default scene to out/demo.png.
	@mkdir -p out
	$(PROGRAM) render stilllife -o out/demo.png

test: setup  ## Build everything and run every test, the Python ones too.
	cmake --preset release
	cmake --build --preset release
	tools/run_tests.py build/release
	tools/test_wheel.sh

wheel: setup  ## Build the Python wheel, with its libraries: build/python/dist/.
	tools/build_wheel.sh

test-python: setup  ## Build the wheel, install it into a clean virtual environment, and run the Python tests.
	tools/test_wheel.sh

test-arm:  ## Build the kernels and their tests for 64-bit ARM, and run them under QEMU.
	tools/test_arm.sh

test-wasm: ## Build the kernels and their tests for WebAssembly, and run them under Node.js.
	tools/test_wasm.sh

check: setup  ## What a change must pass before it is shared: format, warnings as errors, the sanitizers.
	@tools/setup.sh clang-format clang-14 libclang-rt-14-dev
	tools/format.sh --check
	cmake --preset dev && cmake --build --preset dev && tools/run_tests.py build/dev
	cmake --preset asan && cmake --build --preset asan && tools/run_tests.py build/asan
	cmake --preset tsan && cmake --build --preset tsan && tools/run_tests.py build/tsan
	tools/fuzz.sh 20

fuzz: setup  ## Feed the readers with random bytes, ten minutes each.
	@tools/setup.sh clang-14 libclang-rt-14-dev
	tools/fuzz.sh 600

# Where the variable BOXWOOD_MODELS names a folder of real models (CONTRIBUTING.md), these come first.
MODELS := $(if $(BOXWOOD_MODELS),$(addprefix $(BOXWOOD_MODELS)/,bunny.obj dragon.ply kitchen/scene.pbrt))
bench: build  ## Measure builds and rays beside Embree, on made scenes and on the models in $BOXWOOD_MODELS.
	$(PROGRAM) bench $(MODELS) soup:1000000 terrain:2048

microbench: setup  ## Measure queries and builders piece by piece.
	cmake --preset release
	cmake --build --preset release --target boxwood_bench
	build/release/bench/boxwood_bench

format:  ## Lay out every source file as .clang-format says.
	@tools/setup.sh clang-format
	tools/format.sh

docs: build  ## Draw the pictures and charts of README.md and docs/ anew, then check every snippet and link.
	tools/draw_docs.sh
	tools/check_docs.py

clean:   ## Remove what was built.
	rm -rf build out
