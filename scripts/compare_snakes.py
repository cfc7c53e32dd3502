#!/usr/bin/python3
"""Snakes of knead and of scikit-image on the same images, with the same energies, starts and stop criterion.

    scripts/compare_snakes.py [--knead build/release/knead] [--images ../shared/data/images] [--runs 5]

prints for each example of scikit-image the medians of the processor times (so that other programs do not count), taken in
turns, their ratio and how far the contours are apart; then how well morphological contours and snakes agree with silhouettes. Needs Debian's python3-skimage.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent.parent
arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
arguments.add_argument("--knead", default=HERE / "build/release/knead", type=pathlib.Path)
arguments.add_argument("--images", default=HERE.parent / "shared/data/images", type=pathlib.Path)
arguments.add_argument("--runs", default=5, type=int)
options = arguments.parse_args()
os.environ["OPENBLAS_NUM_THREADS"] = "1"  # processor time counts all threads
try:
    import numpy as np
    import skimage
    from scipy import ndimage
    from skimage import color, filters, io, segmentation
except ImportError as missing:
    sys.exit(f"{missing.name} is not there: nothing is compared (apt-get install python3-skimage, and run by /usr/bin/python3)")
for path in (options.knead, options.images):
    if not path.exists():
        sys.exit(f"{path} is not there: nothing is compared")


def children_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_knead(image, script, directory, mask=False):
    """Processor seconds of the whole program, what it printed, and the contour, or the mask, that it wrote."""
    (directory / "script.json").write_text(json.dumps({"knead": 2, **script}))
    written = directory / ("mask.png" if mask else "contour.csv")
    command = [options.knead, "snake", options.images / image, "--script", directory / "script.json",
               "--mask" if mask else "--output", written]
    begin = children_seconds()
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    seconds = children_seconds() - begin
    result = io.imread(written) > 127 if mask else np.loadtxt(written, delimiter=",", skiprows=1)[:, 1:]
    return seconds, done.stdout, result


def distance(places, line, closed):
    """The mean distance of places from a polygon."""
    a, b = (line, np.roll(line, -1, 0)) if closed else (line[:-1], line[1:])
    along = b - a
    share = np.clip(((places[:, None] - a) * along).sum(2) / (along ** 2).sum(1), 0, 1)
    return np.sqrt(((a + share[..., None] * along - places[:, None]) ** 2).sum(2)).min(1).mean()


def dice(a, b):
    return 2 * (a & b).sum() / (a.sum() + b.sum())


def line(start, end, count):
    return np.array([np.linspace(start[0], end[0], count), np.linspace(start[1], end[1], count)]).T


turn = np.linspace(0, 2 * np.pi, 400)
face = np.array([220 + 100 * np.cos(turn), 100 + 100 * np.sin(turn)]).T  # x, y
stiff, soft = dict(alpha=0.015, beta=10, gamma=0.001), dict(alpha=0.1, beta=1, gamma=0.1)
# name, image, smoothing, start, closed, ends, energies of both, stiffness
examples = [
    ("astronaut, closed", "astronaut.png", 3, face, True, "periodic", dict(w_line=0, w_edge=1), stiff),
    ("text, fixed ends", "text.png", 1, line((5, 136), (424, 50), 100), False, "fixed", dict(w_line=-5, w_edge=0), soft),
    ("text, free ends", "text.png", 3, line((5, 70), (424, 40), 100), False, "free", dict(w_line=-5, w_edge=0), soft),
]


def compare(name, file, smoothing, start, closed, ends, energy, stiffness, control_points, directory):
    image = io.imread(options.images / file)
    image = color.rgb2gray(image) if image.ndim == 3 else skimage.img_as_float(image)
    script = {
        "image": {"smoothing": smoothing, "region": 0, "line": energy["w_line"], "edge": energy["w_edge"]},
        "settings": {"control_points": control_points, "units": len(start) - (0 if closed else 1), **stiffness,
                     "end_tension": 1 if ends == "free" else 0, "motion": 0.1, "max_iterations": 2500},
        "snakes": [{"shape": "points", "points": start.tolist(), "closed": closed, "hold_ends": ends == "fixed"}],
    }
    theirs, ours, whole = [], [], []
    for _ in range(options.runs):
        begin = time.process_time()
        smooth = filters.gaussian(image, smoothing, preserve_range=False)
        snake = segmentation.active_contour(smooth, start[:, ::-1], boundary_condition=ends, **stiffness, **energy)
        theirs.append(time.process_time() - begin)
        seconds, said, contour = run_knead(file, script, directory)
        ours.append(sum(float(part) for part in re.findall(r"([\d.]+) s for", said)))
        whole.append(seconds)
    snake = snake[:, ::-1]
    apart = (distance(contour, snake, closed) + distance(snake, contour, closed)) / 2
    a, b, all_of_it = (statistics.median(times) for times in (theirs, ours, whole))
    print(f"{name:22}{len(start):>8}{control_points:>16}{a:>14.4f}{b:>9.4f}{a / b:>8.1f}{a / all_of_it:>15.1f}{apart:>12.2f}")


def silhouettes(directory):
    colours = io.imread(options.images / "seastar2.png")[..., :3]
    red = skimage.img_as_float(colours[..., 0])
    pieces, _ = ndimage.label(red > filters.threshold_otsu(red))
    silhouette = ndimage.binary_fill_holes(pieces == 1 + np.argmax(np.bincount(pieces.ravel())[1:]))
    for name, image in (("grey", color.rgb2gray(colours)), ("red", red)):
        found = segmentation.morphological_geodesic_active_contour(
            segmentation.inverse_gaussian_gradient(image, alpha=1000, sigma=2), 100,
            init_level_set=segmentation.disk_level_set(image.shape, center=(163, 137), radius=135),
            smoothing=2, threshold=0.3, balloon=-1).astype(bool)
        print(f"starfish, silhouette in its red: morphological contour in {name:5}{dice(found, silhouette):8.4f}")
    script = {
        "channel": "red",
        "image": {"smoothing": 2, "region": 1},
        "settings": {"control_points": 150, "units": 1000, "alpha": 0.05, "beta": 0.5, "gamma": 0.1, "motion": 0.05},
        "snakes": [{"centre": [137, 163], "radii": 135}],
    }
    _, said, mask = run_knead("seastar2.png", script, directory, mask=True)
    print(f"starfish, silhouette in its red: snake in red                {dice(mask, silhouette):8.4f}  {said.splitlines()[-1]}")
    coins = io.imread(options.images / "coins.png")
    markers = np.where(coins < 30, 1, np.where(coins > 150, 2, 0))  # scikit-image's tutorial of these coins
    pieces, _ = ndimage.label(ndimage.binary_fill_holes(segmentation.watershed(filters.sobel(coins), markers) - 1))
    silhouette = np.isin(pieces, 1 + np.flatnonzero(np.bincount(pieces.ravel())[1:] > 100))
    script = {
        "image": {"smoothing": 1, "region": 1, "relative_region": True},
        "settings": {"control_points": 12, "units": 100, "alpha": 0.5, "beta": 50, "gamma": 1, "band": 8,
                     "max_iterations": 500, "motion": 0.02},
        "blobs": {"radii": [12, 34], "contrast": 0.2, "start": 0.8},
    }
    _, _, mask = run_knead("coins.png", script, directory, mask=True)
    reference = io.imread(options.images / "ref_coins_morphgac.png") > 0
    print(f"coins, watershed of scikit-image's tutorial: morphological contour  {dice(reference, silhouette):8.4f}")
    print(f"coins, watershed of scikit-image's tutorial: snakes                 {dice(mask, silhouette):8.4f}")
    print(f"coins: snakes with morphological contour                            {dice(mask, reference):8.4f}")


with tempfile.TemporaryDirectory() as temporary:
    print(f"scikit-image {skimage.__version__} and knead: processor seconds for smoothing and snake, the image in memory; medians of")
    print(f"{options.runs} runs in turns; 'ratio, whole': to the whole program, which also starts, decodes and writes")
    print(f"{'':22}{'points':>8}{'control points':>16}{'scikit-image':>14}{'knead':>9}{'ratio':>8}{'ratio, whole':>15}{'apart (px)':>12}")
    for example in examples:
        for control_points in (50, len(example[3])):
            compare(*example, control_points, pathlib.Path(temporary))
    silhouettes(pathlib.Path(temporary))
