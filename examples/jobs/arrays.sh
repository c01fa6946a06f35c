#!/usr/bin/env bash
# All fields of a solution for xarray, NumPy and ParaView. Needs the extra `arrays`.
set -euo pipefail
rough-friction solve table1-rough --grid 64 --netcdf fields.nc --npz fields.npz --vtk fields.vtu --json fields.json
python - <<'END'
import numpy as np
import xarray

fields = xarray.open_dataset("fields.nc")
row = fields.pressure.sel(y=0.8e-3, method="nearest")  # Pa, along x
load = fields.pressure.integrate(("x", "y"))  # N, slopes neglected; no contact at the border
print(f"unit {fields.pressure.units}, highest on the line {float(row.max()):.4g}, sum {float(load):.3f} N")
print(f"NumPy: {np.load('fields.npz')['pressure'].max():.6g}, attribute: {fields.attrs['max_pressure']:.6g}")
END
