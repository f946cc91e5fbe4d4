"""Mitsuba 3 on boxes of crates/tyndall/scenes/bench (fog, none, a beam, a bright cloud): prints one JSON line per
measurement.

usage: mitsuba_boxes.py VARIANT MASK_DIR [--resolution 128] [--spp 4 16 64] [--seeds 8] [--scenes NAME...]

E = 1 / (MSE_Y x user CPU s), MSE_Y from the variance over seeds, without the pixels of mask-SCENE.pbm (headline) and
over the whole frame. One thread; the first picture, which compiles the kernels, is not counted.
"""

import argparse
import json
import math
import pathlib
import resource

import drjit
import mitsuba as mi
import numpy as np

ARGUMENTS = argparse.ArgumentParser()
ARGUMENTS.add_argument("variant")
ARGUMENTS.add_argument("masks", type=pathlib.Path)
ARGUMENTS.add_argument("--resolution", type=int, default=128)
ARGUMENTS.add_argument("--spp", type=int, nargs="+", default=[4, 16, 64])
ARGUMENTS.add_argument("--seeds", type=int, default=8)
SCENES = ["fog-box", "empty-box", "beam", "cloud-box"]
ARGUMENTS.add_argument("--scenes", nargs="+", choices=SCENES, default=SCENES)
A = ARGUMENTS.parse_args()
mi.set_variant(A.variant)
mi.set_log_level(mi.LogLevel.Error)
if A.variant.startswith("llvm"):
    drjit.set_thread_count(1)
T = mi.ScalarTransform4f

# knots of the pbrt files
WHITE = [(360, 0.7), (400, 0.72), (500, 0.74), (830, 0.74)]
GREEN = [(360, 0.09), (460, 0.1), (500, 0.32), (530, 0.47), (560, 0.38), (600, 0.16), (640, 0.11), (830, 0.14)]
RED = [(360, 0.05), (560, 0.05), (600, 0.35), (640, 0.62), (830, 0.66)]
# sigma_s and sigma_a
MEDIA = {
    "fog-box": (
        [(360, 1), (450, 1), (500, 0.9), (550, 0.7), (600, 0.35), (650, 0.2), (700, 0.15), (780, 0.1), (830, 0.1)],
        [(360, 0.02), (400, 0.02), (550, 0.03), (600, 0.25), (650, 0.5), (700, 0.6), (780, 0.7), (830, 0.7)],
    ),
    "beam": ([(360, 0.12), (550, 0.1), (830, 0.05)], [(360, 0.005), (830, 0.02)]),
    "cloud-box": ([(360, 5), (830, 3.5)], [(360, 0.005), (500, 0.02), (830, 0.1)]),
}


def planck(wavelength_nm, temperature=6500.0):
    metres = wavelength_nm * 1e-9
    return 1 / (metres**5 * math.expm1(0.01438776877 / (metres * temperature)))


GRID = np.arange(360.0, 831.0, 5.0)


def table(values):
    return {
        "type": "regular", "wavelength_min": 360.0, "wavelength_max": 830.0,
        "values": ", ".join(f"{v:.9g}" for v in values),
    }


def curve(knots):
    return table(np.interp(GRID, *zip(*knots)))


def wall(bsdf, to_world):
    return {"type": "rectangle", "to_world": to_world, "bsdf": {"type": "ref", "id": bsdf}}


def box(bsdf, to_world):
    return {"type": "cube", "to_world": to_world, "bsdf": {"type": "ref", "id": bsdf}}


def thermal(value):
    return table([value * planck(x) / planck(560.0) for x in GRID])


def light(name):
    """A lamp, or the beam: pbrt's scale over the mean of a black body under y-bar, 1.0048 of its value at 560 nm."""
    if name != "beam":
        place = T().translate([0, 0.97, 0.01]).rotate([1, 0, 0], 90).scale([0.23, 0.19, 0.19])
        return {**wall("white", place), "emitter": {"type": "area", "radiance": thermal(15)}}
    return {
        "type": "spot", "intensity": thermal(60 * 15 / 14.9283176), "cutoff_angle": 8.0, "beam_width": 6.0,
        "to_world": T().look_at(origin=[-0.9, 0.9, 0.3], target=[0.6, -1, -0.2], up=[0, 1, 0]),
    }


def scene(name, sampler, spp):
    s = {
        "type": "scene",
        "integrator": {"type": "volpath" if name in MEDIA else "path", "max_depth": 65},
        "sensor": {
            "type": "perspective", "fov": 39.3077, "near_clip": 0.001, "far_clip": 100.0,
            "to_world": T().look_at(origin=[0, 0, 3.9], target=[0, 0, 0], up=[0, 1, 0]),
            "sampler": {"type": sampler, "sample_count": spp},
            "film": {
                "type": "hdrfilm", "width": A.resolution, "height": A.resolution, "pixel_format": "xyz",
                "component_format": "float32", "rfilter": {"type": "box"},
            },
        },
        "white": {"type": "diffuse", "id": "white", "reflectance": curve(WHITE)},
        "green": {"type": "diffuse", "id": "green", "reflectance": curve(GREEN)},
        "red": {"type": "diffuse", "id": "red", "reflectance": curve(RED)},
        "floor": wall("white", T().translate([0, -1, 0]).rotate([1, 0, 0], -90)),
        "ceiling": wall("white", T().translate([0, 1, 0]).rotate([1, 0, 0], 90)),
        "back": wall("white", T().translate([0, 0, -1])),
        "right": wall("green", T().translate([1, 0, 0]).rotate([0, 1, 0], -90)),
        "left": wall("red", T().translate([-1, 0, 0]).rotate([0, 1, 0], 90)),
        "small": box("white", T().translate([0.335, -0.7, 0.38]).rotate([0, 1, 0], -17).scale(0.3)),
        "large": box("white", T().translate([-0.33, -0.4, -0.28]).rotate([0, 1, 0], 18.25).scale([0.3, 0.61, 0.3])),
        "lamp": light(name),
    }
    if name in MEDIA:
        sigma_s, sigma_a = (np.interp(GRID, *zip(*knots)) for knots in MEDIA[name])
        medium = {
            "type": "homogeneous", "sigma_t": table(sigma_s + sigma_a), "albedo": table(sigma_s / (sigma_s + sigma_a)),
            "phase": {"type": "isotropic"},
        }
        s["fog"] = {"type": "cube", "to_world": T().scale(0.98), "bsdf": {"type": "null"}, "interior": medium}
    return mi.load_dict(s)


def hidden(name):
    words = (A.masks / f"mask-{name}.pbm").read_text().split()[1:]
    width, height = int(words[0]), int(words[1])
    return np.array(words[2:], dtype=int).reshape(height, width) == 1


def measure(name, sampler, spp):
    loaded = scene(name, sampler, spp)
    np.array(mi.render(loaded, spp=spp, seed=10_000))
    pictures, seconds = [], []
    for seed in range(A.seeds):
        before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
        pictures.append(np.array(mi.render(loaded, spp=spp, seed=seed), dtype=np.float64)[..., 1])
        seconds.append(resource.getrusage(resource.RUSAGE_SELF).ru_utime - before)
    variance, user = np.var(pictures, axis=0, ddof=1), float(np.mean(seconds))
    print(json.dumps({
        "renderer": f"Mitsuba {mi.__version__} {A.variant}, {sampler}", "scene": name, "spp": spp,
        "headline": 1 / (float(variance[~hidden(name)].mean()) * user), "whole": 1 / (float(variance.mean()) * user),
        "samples_per_second": A.resolution**2 * spp / user, "mean_y": float(np.mean(pictures)),
    }), flush=True)


for scene_name in A.scenes:
    for sampler_name in ("independent", "multijitter"):
        for samples in A.spp:
            measure(scene_name, sampler_name, samples)
