"""How fast is it, beside embreex, trimesh and Open3D? `python -m boxwood.bench --help`."""
