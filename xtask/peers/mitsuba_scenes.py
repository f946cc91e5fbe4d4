"""Mitsuba 3 on the scenes of crates/tyndall/scenes/bench, built anew in its own terms.

usage: mitsuba_scenes.py VARIANT FOLDER [--resolution 128] [--spp 4 16 64 256] [--seeds 8] [--scenes NAME...]
       mitsuba_scenes.py VARIANT FOLDER --first-pixel --scenes NAME

FOLDER is that of `cargo xtask bench`, which wrote the cloud, the hills and the images into FOLDER/scenes. Prints one JSON
line per measurement; the pictures of luminance lie in FOLDER/pictures as 32-bit floats, seed by seed. User CPU seconds of
rendering alone, on one thread; the first picture, which compiles the kernels, is not counted. With --first-pixel: one
pixel in a new process, import and compilation included.
"""

import time

START = time.perf_counter()

import argparse
import json
import pathlib
import resource

import drjit
import mitsuba as mi
import numpy as np

ARGUMENTS = argparse.ArgumentParser()
ARGUMENTS.add_argument("variant")
ARGUMENTS.add_argument("folder", type=pathlib.Path)
ARGUMENTS.add_argument("--resolution", type=int, default=128)
ARGUMENTS.add_argument("--spp", type=int, nargs="+", default=[4, 16, 64, 256])
ARGUMENTS.add_argument("--seeds", type=int, default=8)
ARGUMENTS.add_argument("--samplers", nargs="+", default=["independent", "multijitter"])
ARGUMENTS.add_argument("--first-pixel", action="store_true")
BOXES = ["fog-box", "empty-box", "dark-fog", "cloud-box", "small-lamp", "beam"]
SCENES = [*BOXES, "cloud-grid", "smoke", "room", "plates", "terrain"]
ARGUMENTS.add_argument("--scenes", nargs="+", choices=SCENES, default=SCENES)
A = ARGUMENTS.parse_args()
mi.set_variant(A.variant)
mi.set_log_level(mi.LogLevel.Error)
if A.variant.startswith("llvm"):
    drjit.set_thread_count(1)
T = mi.ScalarTransform4f
FILES = A.folder / "scenes"

# knots of the pbrt files
WHITE = [(360, 0.7), (400, 0.72), (500, 0.74), (830, 0.74)]
GREEN = [(360, 0.09), (460, 0.1), (500, 0.32), (530, 0.47), (560, 0.38), (600, 0.16), (640, 0.11), (830, 0.14)]
RED = [(360, 0.05), (560, 0.05), (600, 0.35), (640, 0.62), (830, 0.66)]
ETA = [(360, 1.5), (480, 1.2), (560, 0.9), (620, 0.3), (830, 0.2)]
K = [(360, 2), (480, 2.4), (560, 2.6), (620, 3.4), (830, 5.3)]
MIST = ([(360, 0.12), (550, 0.1), (830, 0.05)], [(360, 0.005), (830, 0.02)])
# sigma_s and sigma_a
MEDIA = {
    "fog-box": (
        [(360, 1), (450, 1), (500, 0.9), (550, 0.7), (600, 0.35), (650, 0.2), (700, 0.15), (780, 0.1), (830, 0.1)],
        [(360, 0.02), (400, 0.02), (550, 0.03), (600, 0.25), (650, 0.5), (700, 0.6), (780, 0.7), (830, 0.7)],
    ),
    "dark-fog": ([(360, 0.9), (830, 0.5)], [(360, 0.5), (830, 0.9)]),
    "cloud-box": ([(360, 5), (830, 3.5)], [(360, 0.005), (500, 0.02), (830, 0.1)]),
    "small-lamp": MIST,
    "beam": MIST,
}
CLOUD_ALBEDO = [(360, 0.99), (500, 0.99), (560, 0.97), (620, 0.85), (700, 0.75), (830, 0.7)]

SMOKE_ALBEDO = [(360, 0.5), (500, 0.65), (600, 0.8), (830, 0.85)]

GRID = np.arange(360.0, 831.0, 5.0)


def table(values):
    return {
        "type": "regular", "wavelength_min": 360.0, "wavelength_max": 830.0,
        "values": ", ".join(f"{v:.9g}" for v in values),
    }


def curve(knots):
    return table(np.interp(GRID, *zip(*knots)))


def thermal(scale, temperature=6500.0):
    """What pbrt makes of a black body: the mean under y-bar becomes `scale`."""
    metres = GRID * 1e-9
    planck = 1 / (metres**5 * np.expm1(0.01438776877 / (metres * temperature)))
    return table(scale * planck / (np.sum(planck * Y_BAR) / np.sum(Y_BAR)))


# CIE 1931 y-bar at the knots of GRID
Y_BAR = np.array([float(np.array(mi.cie1931_xyz(float(x))).ravel()[1]) for x in GRID])


def diffuse(reflectance):
    return {"type": "diffuse", "reflectance": reflectance}


def picture(name):
    """An image whose last row is at v = 0, as pbrt has it; Mitsuba has the first there."""
    rows = np.array(mi.Bitmap(str(FILES / name)))
    upright = mi.Bitmap(np.ascontiguousarray(rows[::-1]))
    return diffuse({"type": "bitmap", "bitmap": upright, "raw": False, "filter_type": "bilinear"})


def metal(alpha):
    return {"type": "roughconductor", "distribution": "ggx", "alpha": alpha, "eta": curve(ETA), "k": curve(K)}


def wall(bsdf, to_world):
    return {"type": "rectangle", "to_world": to_world, "bsdf": bsdf}


def ball(centre, radius, **more):
    return {"type": "sphere", "center": centre, "radius": radius, **more}


def emitter(scale, temperature=6500.0):
    return {"type": "area", "radiance": thermal(scale, temperature)}


def lamp_ball(centre, radius, light):
    """White, as in the pbrt files: lamps reflect, too."""
    return ball(centre, radius, bsdf=diffuse(curve(WHITE)), emitter=light)


def ceiling_lamp(scale):
    place = T().translate([0, 0.97, 0.01]).rotate([1, 0, 0], 90).scale([0.23, 0.19, 0.19])
    return {**wall(diffuse(curve(WHITE)), place), "emitter": emitter(scale)}


def shell(floor, back):
    """The five walls of the box."""
    white = diffuse(curve(WHITE))
    return {
        "floor": wall(floor, T().translate([0, -1, 0]).rotate([1, 0, 0], -90)),
        "ceiling": wall(white, T().translate([0, 1, 0]).rotate([1, 0, 0], 90)),
        "back": wall(back, T().translate([0, 0, -1])),
        "right": wall(diffuse(curve(GREEN)), T().translate([1, 0, 0]).rotate([0, 1, 0], -90)),
        "left": wall(diffuse(curve(RED)), T().translate([-1, 0, 0]).rotate([0, 1, 0], 90)),
    }


def box_light(name):
    if name == "small-lamp":
        return lamp_ball([0.1, 0.2, 0.1], 0.05, emitter(150))
    if name != "beam":
        return ceiling_lamp(14.9283176)
    return {
        "type": "spot", "intensity": thermal(60), "cutoff_angle": 8.0, "beam_width": 6.0,
        "to_world": T().look_at(origin=[-0.9, 0.9, 0.3], target=[0.6, -1, -0.2], up=[0, 1, 0]),
    }


def fog(name):
    sigma_s, sigma_a = (np.interp(GRID, *zip(*knots)) for knots in MEDIA[name])
    medium = {
        "type": "homogeneous", "sigma_t": table(sigma_s + sigma_a), "albedo": table(sigma_s / (sigma_s + sigma_a)),
        "phase": {"type": "isotropic"},
    }
    return {"type": "cube", "to_world": T().scale(0.98), "bsdf": {"type": "null"}, "interior": medium}


def boxes(name):
    white = diffuse(curve(WHITE))
    small = T().translate([0.335, -0.7, 0.38]).rotate([0, 1, 0], -17).scale(0.3)
    large = T().translate([-0.33, -0.4, -0.28]).rotate([0, 1, 0], 18.25).scale([0.3, 0.61, 0.3])
    parts = {
        **shell(white, white),
        "small": {"type": "cube", "to_world": small, "bsdf": white},
        "large": {"type": "cube", "to_world": large, "bsdf": white},
        "lamp": box_light(name),
    }
    return {**parts, "fog": fog(name)} if name in MEDIA else parts


def outdoors():
    """Sky, and the lamp high above."""
    lamp = T().translate([0.8, 2, 0.8]).rotate([1, 0, 0], 90).scale(0.5)
    return {
        "sky": {"type": "constant", "radiance": thermal(0.49761059)},
        "lamp": {**wall(diffuse(curve(WHITE)), lamp), "emitter": emitter(14.9283176)},
    }


def grid(name, side, sigma_t, albedo, g, low, high):
    """A box of densities."""
    density = np.fromfile(FILES / f"{name}.f32", dtype="<f4").reshape(side, side, side, 1)
    low, high = np.array(low), np.array(high)
    half = (high - low) / 2
    medium = {
        "type": "heterogeneous", "scale": sigma_t, "has_spectral_extinction": False,
        "sigma_t": {
            "type": "gridvolume", "grid": mi.VolumeGrid(np.ascontiguousarray(density)), "wrap_mode": "clamp",
            "to_world": T().translate(low.tolist()).scale((high - low).tolist()),
        },
        "albedo": curve(albedo), "phase": {"type": "hg", "g": g},
    }
    place = T().translate((low + half).tolist()).scale(half.tolist())
    return {"type": "cube", "to_world": place, "bsdf": {"type": "null"}, "interior": medium}


def cloud_grid():
    return {
        **outdoors(),
        "floor": wall(diffuse(curve(WHITE)), T().translate([0, -1, 0]).rotate([1, 0, 0], -90).scale(4)),
        "cloud": grid("cloud-grid", 64, 12.0, CLOUD_ALBEDO, 0.6, [-0.75] * 3, [0.75] * 3),
    }


def smoke():
    return {**boxes("smoke"), "smoke": grid("smoke", 32, 10.0, SMOKE_ALBEDO, 0.3, [-0.4, -0.95, 0.05], [0.3, 0.45, 0.75])}


def terrain():
    hills = {"type": "ply", "filename": str(FILES / "terrain.ply"), "face_normals": True}
    return {**outdoors(), "hills": {**hills, "bsdf": {"type": "twosided", "nested": diffuse(curve(GREEN))}}}


def room():
    return {
        **shell(picture("tiles.png"), picture("cloth.png")),
        "metal": ball([0.42, -0.62, 0.3], 0.38, bsdf=metal(0.15)),
        "white": ball([-0.4, -0.55, -0.25], 0.45, bsdf=diffuse(curve(WHITE))),
        "lamp": ceiling_lamp(9.9522117),
        "bulb": lamp_ball([-0.7, 0.1, 0.5], 0.06, emitter(40, 3000.0)),
    }


def plates():
    white = diffuse(curve(WHITE))
    parts = {
        "floor": wall(white, T().translate([0, -1, 0]).rotate([1, 0, 0], -90).scale(4)),
        "back": wall(white, T().translate([0, 1.5, -1.2]).scale([4, 2.5, 1])),
    }
    for alpha, y, z, turn in [(0.01, -0.72, 0.75, -78.65), (0.05, -0.48, 0.33, -72.67), (0.1, -0.24, -0.09, -64.74),
                              (0.25, 0, -0.51, -50.31)]:
        place = T().translate([0, y, z]).rotate([1, 0, 0], turn).scale([1.1, 0.17, 1])
        parts[f"plate_{len(parts)}"] = wall({"type": "twosided", "nested": metal(alpha)}, place)
    for x, radius in [(-0.9, 0.02), (-0.3, 0.05), (0.3, 0.1), (0.9, 0.2)]:
        parts[f"lamp_{len(parts)}"] = lamp_ball([x, 0.62, -0.55], radius, emitter(0.03 / radius**2))
    return parts


CAMERAS = {
    "cloud-grid": ([0, 0.1, 3.9], [0, -0.1, 0]), "terrain": ([0, 0.9, 2.4], [0, -0.25, 0]),
    "plates": ([0, 0.5, 3.6], [0, -0.1, 0]),
}
PARTS = {"cloud-grid": cloud_grid, "smoke": smoke, "terrain": terrain, "room": room, "plates": plates}


def scene(name, sampler, spp, resolution):
    origin, target = CAMERAS.get(name, ([0, 0, 3.9], [0, 0, 0]))
    parts = PARTS[name]() if name in PARTS else boxes(name)
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "volpath" if name in MEDIA or name in ("cloud-grid", "smoke") else "path", "max_depth": 65},
        "sensor": {
            "type": "perspective", "fov": 39.3077, "near_clip": 0.001, "far_clip": 100.0,
            "to_world": T().look_at(origin=origin, target=target, up=[0, 1, 0]),
            "sampler": {"type": sampler, "sample_count": spp},
            "film": {
                "type": "hdrfilm", "width": resolution, "height": resolution, "pixel_format": "xyz",
                "component_format": "float32", "rfilter": {"type": "box"},
            },
        },
        **parts,
    })


# Mitsuba divides by 106.7503, the integral of y-bar at a coarser step than that of the table, 106.8569
UNIT = np.float32(106.7502593994140625 / 106.856895)


def user_seconds():
    return resource.getrusage(resource.RUSAGE_SELF).ru_utime


def measure(name, sampler, spp):
    loaded = scene(name, sampler, spp, A.resolution)
    np.array(mi.render(loaded, spp=spp, seed=10_000))
    pictures, seconds = [], []
    # half the seeds where each picture is long, as for the others
    for seed in range(A.seeds if spp <= 64 else max(2, (A.seeds + 1) // 2)):
        before = user_seconds()
        pictures.append(UNIT * np.array(mi.render(loaded, spp=spp, seed=seed), dtype=np.float32)[..., 1])
        seconds.append(user_seconds() - before)
    file = f"mitsuba-{A.variant}-{sampler}-{name}-{spp}.f32"
    np.stack(pictures).astype("<f4").tofile(A.folder / "pictures" / file)
    print(json.dumps({
        "kind": "pictures", "renderer": f"Mitsuba {mi.__version__} {A.variant}, {sampler}", "scene": name, "spp": spp,
        "width": A.resolution, "height": A.resolution, "seconds": seconds, "file": file,
    }), flush=True)


def first_pixel(name):
    np.array(mi.render(scene(name, "independent", 1, 1), spp=1, seed=0))
    print(json.dumps({
        "kind": "start", "renderer": f"Mitsuba {mi.__version__} {A.variant}", "scene": name,
        "seconds": time.perf_counter() - START, "user_seconds": user_seconds(),
        "bytes": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
    }), flush=True)


if A.first_pixel:
    first_pixel(A.scenes[0])
else:
    (A.folder / "pictures").mkdir(parents=True, exist_ok=True)
    for scene_name in A.scenes:
        for sampler_name in A.samplers:
            for samples in A.spp:
                measure(scene_name, sampler_name, samples)
