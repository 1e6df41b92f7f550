"""The error of views through projected mosaics beside that of the same views of the plate carrée original.

The original is a noise planet, made smooth by half its resolution. gdalwarp (cubic, -et 0) makes the mosaics of it at
about twice the resolution in between. The ray caster judges all views by the original (terrella_judge).
Usage: projected_cameras.py BUILD_FOLDER
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

BUILD = pathlib.Path(sys.argv[1]).resolve()
SIZE = (4096, 2048)
HALF = math.pi * 6378137.0
# Half the original's pixel, so that the tiles of all levels have pixels of nearly the same size. Larger ones would show
# less than the original's.
PIXEL_M = HALF / SIZE[0]
# The same at a pole: a degree of the meridian is 111,694 m there, and these maps have a scale of 0.9728.
CAP_PIXEL_M = 111694 * 0.9728 * 180 / SIZE[0]
# Metres of the ground a pixel of the views has below the eye: about four pixels of the original, so that its views too
# show tiles that were rounded once more than the truth.
GROUND_M = 40e3
# Name: system, west, south, east, north, pixel; cameras whose whole view lies on the mosaic.
MOSAICS = {
    "sinusoidal": ("+proj=sinu +datum=WGS84", -HALF, -HALF / 2, HALF, HALF / 2, PIXEL_M,
                   ["30,20,6000000", "0,180,6000000", "46,7,3000000,30,-70", "-50,-100,3500000", "10,-140,4500000",
                    "65,60,3000000"]),
    "utm": ("EPSG:32632", -1200e3, 2200e3, 2200e3, 8000e3, PIXEL_M,
            ["45,9,2700000", "50,6,2500000", "40,12,2300000", "46,7,2000000,30,-80", "35,9,2600000", "55,10,2500000"]),
    "north cap": ("EPSG:3995", -4e6, -4e6, 4e6, 4e6, CAP_PIXEL_M,
                  ["90,0,6000000", "89.9,0,3000000", "88,10,3000000", "80,180,2500000,0,-75", "78,40,3000000",
                   "74,-100,2500000"]),
    "south cap": ("EPSG:3031", -4e6, -4e6, 4e6, 4e6, CAP_PIXEL_M,
                  ["-90,0,6000000", "-89.9,0,3000000", "-88,10,3000000", "-80,180,2500000,0,-75", "-78,40,3000000",
                   "-74,-100,2500000"]),
}


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command}\n{done.stdout}{done.stderr}")
    return done.stdout


def make_original(folder):
    """Half the resolution of the planet, twice enlarged: nothing finer than four pixels is left."""
    run(BUILD / "noise_planet", "--out", folder / "noise.png", "--size", f"{SIZE[0]}x{SIZE[1]}")
    run("gdal_translate", "-q", "-r", "average", "-outsize", "50%", "50%", folder / "noise.png", folder / "half.tif")
    run("gdal_translate", "-q", "-r", "cubicspline", "-outsize", *SIZE, "-a_srs", "EPSG:4326", "-a_ullr", -180, 90, 180, -90,
        folder / "half.tif", folder / "original.tif")
    run("gdal_translate", "-q", "-of", "PNG", folder / "original.tif", folder / "original.png")


def cut(folder, picture):
    """Without loss, since JPEG's would hide the rest."""
    run(BUILD / "terrella", "cut", picture, "-o", folder / f"{picture.stem}.gpkg", "--format", "png", "--force")


def error(folder, tiles, camera):
    pixels = round(0.728 * float(camera.split(",")[2]) / GROUND_M)
    run(BUILD / "terrella", "render", folder / tiles, "-o", folder / "shot.png", "--unlit", "--sky", "off", "--size", f"{pixels}x{pixels}", "--camera", camera, "--cache", "off")
    told = run(BUILD / "terrella_judge", "--picture", folder / "original.png", "--shot", folder / "shot.png",
               "--camera", camera, "--cache", folder / "truth", "--json")
    return json.loads(told)["zones"]["clear"]["rms"]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_original(folder)
        cut(folder, folder / "original.tif")
        print("mosaic       camera                    original  mosaic  ratio")
        for kind, (system, west, south, east, north, pixel_m, cameras) in MOSAICS.items():
            mosaic = folder / "mosaic.tif"
            run("gdalwarp", "-q", "-overwrite", "-r", "cubic", "-et", "0", "-dstalpha", "-t_srs", system, "-te", west, south,
                east, north, "-tr", pixel_m, pixel_m, folder / "original.tif", mosaic)
            cut(folder, mosaic)
            for camera in cameras:
                plain, warped = error(folder, "original.gpkg", camera), error(folder, "mosaic.gpkg", camera)
                print(f"{kind:12} {camera:26} {plain:6.2f}  {warped:6.2f}  {warped / plain:5.2f}", flush=True)
