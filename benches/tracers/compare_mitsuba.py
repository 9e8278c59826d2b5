#!/usr/bin/env python3
"""toyproof's tracer and Mitsuba 3 (llvm_ad_rgb) in turns, one thread each.

    apt-get install libllvm19; python3 -m venv venv; venv/bin/pip install mitsuba==3.9.1 numpy
    DRJIT_LIBLLVM_PATH=/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1 venv/bin/python benches/tracers/compare_mitsuba.py TOYPROOF [ROUNDS]

LLVM 15 and 16 abort on an instruction that Dr.Jit emits. Three comparisons, medians of ROUNDS (5) at 640x360, 16 samples:
the seven spheres of whitted.toml, against Mitsuba's path integrator and against one that stops at diffuse surfaces;
exercise 13, path-traced, with the root mean square error of tone-mapped images against a reference of the same renderer,
from which the time to an error of 0.01 follows, as errors fall with the square root of the samples.

The scenes differ in what Mitsuba lacks: no ambient light; a uniform background; lights that fall off with the square of the
distance, equal at (0, 0, -6); a square instead of an infinite plane; a Beckmann lobe instead of Phong's. Glass follows one
branch chosen at random there, and both branches here. The diffuse-stopping integrator runs the rays that toyproof's Whitted
integrator runs, but for that."""

import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time
import tomllib

SIZE, SAMPLES = (640, 360), 16
HERE = pathlib.Path(__file__).resolve().parent
WHITTED, PATHS = HERE / "whitted.toml", HERE / "../../glsl/13-importance-sampling.toml"

try:
    import drjit as dr
    import mitsuba as mi
    import numpy as np

    mi.set_variant("llvm_ad_rgb")
    dr.eval(mi.Float(1) + mi.Float(1))
except Exception as error:  # Dr.Jit reports a missing LLVM by exceptions of several types.
    sys.exit(f"skipped: Mitsuba 3 with LLVM is not usable here: {error}")


def material(of):
    """The BSDF that is nearest to a material of a scene file."""
    color = {"type": "rgb", "value": of["color"]}
    match of["model"]:
        case "mirror":
            return {"type": "conductor", "material": "none", "specular_reflectance": color}
        case "glass":
            return {"type": "dielectric", "int_ior": of["ior"], "ext_ior": 1.0}
        case "glossy":
            # The Beckmann lobe whose half-vector distribution has the variance of Blinn's with 4 n, which is about Phong's n.
            width = math.sqrt(2 / (4 * of["exponent"] + 2))
            return {"type": "roughconductor", "material": "none", "distribution": "beckmann", "alpha": width,
                    "specular_reflectance": color}
        case _:
            return {"type": "diffuse", "reflectance": color}


def convert(file, sampler="independent"):
    """A scene file as Mitsuba's dictionary."""
    scene = tomllib.loads(file.read_text())
    look = mi.ScalarTransform4f()
    all_parts = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": scene["film"]["max_depth"], "rr_depth": 10000},
        "sensor": {
            "type": "perspective", "fov_axis": "x", "fov": 2 * math.degrees(math.atan(0.5)),
            "to_world": look.look_at(origin=[0, 0, 0], target=[0, 0, -1], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": SIZE[0], "height": SIZE[1], "pixel_format": "rgb",
                     "rfilter": {"type": "box"}},
            "sampler": {"type": sampler},
        },
    }
    if (color := scene["background"].get("color")) is not None:
        all_parts["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": color}, "sampling_weight": 0.0}
    for number, light in enumerate(scene.get("light", [])):
        square = math.dist(light["position"], (0, 0, -6)) ** 2
        intensity = [math.pi * square * part for part in light["color"]]
        all_parts[f"light{number}"] = {"type": "point", "position": light["position"],
                                       "intensity": {"type": "rgb", "value": intensity}}
    for number, sphere in enumerate(scene.get("sphere", [])):
        part = {"type": "sphere", "center": sphere["center"], "radius": sphere["radius"]}
        if sphere["material"]["model"] == "emitter":
            part["light"] = {"type": "area", "radiance": {"type": "rgb", "value": sphere["material"]["color"]}}
        else:
            part["bsdf"] = material(sphere["material"])
        all_parts[f"sphere{number}"] = part
    for number, plane in enumerate(scene.get("plane", [])):
        place = look.translate([0, plane["point"][1], 0]).rotate([1, 0, 0], -90).scale([200, 200, 1])
        all_parts[f"plane{number}"] = {"type": "rectangle", "to_world": place, "bsdf": material(plane["material"])}
    return mi.load_dict(all_parts)


class StopAtDiffuse(mi.SamplingIntegrator):
    """Follows mirrors and glass; at a diffuse surface, adds the light of every lamp and ends."""

    max_depth = 6

    @dr.syntax
    def sample(self, scene, sampler, ray, medium=None, active=True):
        ray, active = mi.Ray3f(ray), mi.Bool(active)
        light, weight, segments = mi.Spectrum(0), mi.Spectrum(1), mi.UInt32(0)
        lamps = len(scene.emitters())
        context = mi.BSDFContext()
        while active:
            hit = scene.ray_intersect(ray, active)
            light += dr.select(active & ~hit.is_valid(), 0.6 * weight, 0)
            active &= hit.is_valid()
            bsdf = hit.bsdf(ray)
            diffuse = active & mi.has_flag(bsdf.flags(), mi.BSDFFlags.Smooth)
            for lamp in range(lamps):
                # The sample selects this lamp; the weight is divided by the probability of that.
                choice = mi.Point2f((lamp + 0.5) / lamps, 0.5)
                direction, radiance = scene.sample_emitter_direction(hit, choice, True, diffuse)
                value = bsdf.eval(context, hit, hit.to_local(direction.d), diffuse)
                light += dr.select(diffuse, weight * value * radiance / lamps, 0)
            segments += 1
            active &= ~diffuse & (segments < self.max_depth)
            scattered, value = bsdf.sample(context, hit, sampler.next_1d(active), sampler.next_2d(active), active)
            weight *= value
            ray = hit.spawn_ray(hit.to_world(scattered.wo))
        return light, True, []


def mitsuba(scene, samples=SAMPLES, seed=0, integrator=None):
    """Milliseconds of processor time, and the image."""
    start = time.process_time()
    image = mi.render(scene, spp=samples, seed=seed, integrator=integrator or scene.integrator())
    dr.eval(image)
    dr.sync_thread()
    return 1e3 * (time.process_time() - start), image


def toyproof(file, sampler, precision, samples=SAMPLES, image=None):
    """Milliseconds that tracing took on one thread, as the command reports."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.argv[1], "render", file, "-v", "-o", image or f"{folder}/image.png", "--size", f"{SIZE[0]}x{SIZE[1]}",
                   "--samples", str(samples), "--sampler", sampler, "--precision", precision]
        report = subprocess.run(command, check=True, capture_output=True, text=True, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    return 1e3 * float(re.search(r"traced in ([\d.]+) s", report.stderr + report.stdout)[1])


def in_turns(programs, rounds):
    """The median time of each program."""
    times = {name: [] for name in programs}
    for run in programs.values():
        run()
    for _ in range(rounds):
        for name, run in programs.items():
            times[name].append(run())
    return {name: statistics.median(of) for name, of in times.items()}


def print_table(times, extra=lambda _: ""):
    for name, taken in times.items():
        ratios = ", ".join(f"{taken / times[own]:.2f} of {own}" for own in times if own.startswith("toyproof"))
        print(f"| {name} | {taken:.0f} ms | {ratios} |{extra(name)}")


def tone_map(image):
    return (image / (1 + image)) ** (1 / 2.2)


def read(path):
    return np.array(mi.Bitmap(str(path)))[:, :, :3].astype(np.float64)


def error(image, reference):
    return float(np.sqrt(np.nanmean((image - reference) ** 2)))


def main():
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    os.sched_setaffinity(0, [0])
    dr.set_thread_count(1)
    spheres = convert(WHITTED)
    stop = StopAtDiffuse(mi.Properties())
    print("The seven spheres, milliseconds of processor time:")
    print_table(in_turns({
        "toyproof f32": lambda: toyproof(WHITTED, "independent", "f32"),
        "toyproof f64": lambda: toyproof(WHITTED, "independent", "f64"),
        "Mitsuba path": lambda: mitsuba(spheres)[0],
        "Mitsuba stopping at diffuse": lambda: mitsuba(spheres, integrator=stop)[0],
    }, rounds))

    scenes = {kind: convert(PATHS, kind) for kind in ("independent", "multijitter")}
    times = in_turns({
        f"toyproof {precision} {sampler}": lambda sampler=sampler, precision=precision: toyproof(PATHS, sampler, precision)
        for precision in ("f32", "f64") for sampler in ("independent", "sobol")
    } | {f"Mitsuba {kind}": lambda scene=scene: mitsuba(scene)[0] for kind, scene in scenes.items()}, rounds)
    errors = {}
    with tempfile.TemporaryDirectory() as folder:
        def ours(sampler, precision, samples):
            toyproof(PATHS, sampler, precision, samples, f"{folder}/image.exr")
            # Reading EXR hangs with one thread.
            dr.set_thread_count(2)
            image = read(f"{folder}/image.exr")
            dr.set_thread_count(1)
            return image

        own_reference = ours("sobol", "f64", 256)
        for precision in ("f32", "f64"):
            for sampler in ("independent", "sobol"):
                errors[f"toyproof {precision} {sampler}"] = error(ours(sampler, precision, SAMPLES), own_reference)
    parts = [np.array(mitsuba(scenes["independent"], 64, 100 + seed)[1]).astype(np.float64) for seed in range(8)]
    reference = tone_map(sum(parts) / len(parts))
    for kind, scene in scenes.items():
        image = np.array(mitsuba(scene)[1]).astype(np.float64)
        errors[f"Mitsuba {kind}"] = error(tone_map(image), reference)
    print("\nExercise 13, path-traced, milliseconds of processor time, error, seconds to an error of 0.01:")
    print_table(times, lambda name: f" {errors[name]:.4f} | {times[name] / 1e3 * (errors[name] / 0.01) ** 2:.2f} s |")


if __name__ == "__main__":
    main()
