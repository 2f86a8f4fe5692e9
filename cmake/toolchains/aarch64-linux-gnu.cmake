# aarch64-linux-gnu.cmake: how is Boxwood built for 64-bit ARM on another machine?
#
# With Debian's cross compiler, and QEMU's user mode to run what was built. The libraries for ARM lie in a folder of
# their own, BOXWOOD_ARM_ROOT, which tools/test_arm.sh fills with Debian's packages; the machine's own are not used.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

set(BOXWOOD_ARM_ROOT "" CACHE PATH "Where the packages for arm64 are unpacked")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES BOXWOOD_ARM_ROOT)

set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu)

# Programs come from here, headers and libraries from there.
set(CMAKE_FIND_ROOT_PATH ${BOXWOOD_ARM_ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
