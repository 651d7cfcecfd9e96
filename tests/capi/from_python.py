"""The interface as Python sees it, through ctypes and the standard library alone: statistics, a refused call and a
sphere pressed into steel, given the path of the shared library."""

import ctypes
import math
import sys
from ctypes import POINTER, Structure, byref, c_double, c_int32, c_int64, c_size_t, c_void_p

brinell = ctypes.CDLL(sys.argv[1])
brinell.brn_last_message.restype = ctypes.c_char_p
brinell.brn_version.restype = ctypes.c_char_p


class Grid(Structure):
    _fields_ = [("struct_size", c_size_t), ("nx", c_int64), ("ny", c_int64), ("dx", c_double), ("dy", c_double),
                ("boundary", c_int32), ("reserved", c_int32)]


class Body(Structure):
    _fields_ = [("struct_size", c_size_t), ("youngs_modulus", c_double), ("poissons_ratio", c_double),
                ("rigid", c_int32), ("reserved", c_int32)]


class Shape(Structure):  # up to radius: a shorter struct is an older client's
    _fields_ = [("struct_size", c_size_t), ("kind", c_int32), ("profile", c_int32), ("radius", c_double)]


class Step(Structure):
    _fields_ = [("struct_size", c_size_t), ("drive", c_int32), ("increments", c_int32), ("target", c_double)]


def stamped(struct, **members):
    return struct(struct_size=ctypes.sizeof(struct), **members)


def call(name, *arguments):
    status = getattr(brinell, name)(*arguments)
    assert status == 0, f"{name}: {status} {brinell.brn_last_message().decode()}"


radius, force, modulus = 1e-3, 1.0, 210e9 / (1 - 0.3**2)
contact_radius = (0.75 * force * radius / modulus) ** (1 / 3)
n = 64
spacing = contact_radius / 20

engine, scene, run = c_void_p(), c_void_p(), c_void_p()
call("brn_engine_create", None, byref(engine))
call("brn_scene_create", byref(scene))
call("brn_scene_set_grid", scene, byref(stamped(Grid, nx=n, ny=n, dx=spacing, dy=spacing)))
call("brn_scene_set_body", scene, 0, byref(stamped(Body, youngs_modulus=210e9, poissons_ratio=0.3)))
call("brn_scene_add_shape", scene, byref(stamped(Shape, kind=1, radius=radius)))
call("brn_scene_add_step", scene, byref(stamped(Step, drive=1, increments=1, target=force)))
assert brinell.brn_scene_add_step(scene, byref(stamped(Step, drive=1, increments=0, target=force))) == 10
call("brn_run_create", engine, scene, byref(run))
call("brn_run_execute", run, None, None)

pressure, count = (c_double * (n * n))(), c_size_t()
brinell.brn_run_get_field.argtypes = [c_void_p, c_int32, POINTER(c_double), c_size_t, POINTER(c_size_t)]
call("brn_run_get_field", run, 1, pressure, n * n, byref(count))
area = sum(p > 0 for p in pressure) * spacing**2
carried = sum(pressure) * spacing**2
print(f"brinell {brinell.brn_version().decode()}: contact radius {math.sqrt(area / math.pi):.4e} m, "
      f"Hertz {contact_radius:.4e} m, carried {carried:.9f} N")
assert count.value == n * n
assert abs(carried / force - 1) < 1e-7
assert abs(math.sqrt(area / math.pi) / contact_radius - 1) < 0.02  # 20 nodes across the radius

brinell.brn_run_destroy(run)
brinell.brn_scene_destroy(scene)
brinell.brn_engine_destroy(engine)
