"""Measures how far a zone like the antimeridian's differs from its surroundings by chance: views from over 21 meridians,
the antimeridian among them, each judged around its own meridian. Run with the noise planet and its tiles:

  build/noise_planet --out noise.png
  build/terrella cut noise.png -o noise.gpkg --format png
  python3 tests/bench/antimeridian_chance.py build noise.png noise.gpkg --height 19134411"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile


def ratio(options, folder, lon):
    camera, shot = f"{options.lat},{lon},{options.height}", folder / "shot.png"
    subprocess.run([options.build / "terrella", "render", options.tiles, "--unlit", "--size", "1024x1024", "--camera",
                    camera, "-o", shot], check=True, stdout=subprocess.DEVNULL)
    judged = json.loads(subprocess.run(
        [options.build / "terrella_judge", "--picture", options.picture, "--shot", shot, "--camera", camera,
         "--meridian", str(lon), "--json"], check=True, capture_output=True, text=True).stdout)["zones"]
    zone, beside = judged["antimeridian"], judged["antimeridian surroundings"]
    return zone["rms"] / beside["rms"], zone, beside


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("picture")
    parser.add_argument("tiles")
    parser.add_argument("--lat", default="0")
    parser.add_argument("--height", default="19134411", help="metres; default: four radii from the centre")
    parser.add_argument("--meridians", type=int, default=21)
    options = parser.parse_args()
    ratios = []
    with tempfile.TemporaryDirectory(prefix="terrella-chance-") as folder:
        for k in range(options.meridians):
            lon = -180.0 + k * 360.0 / options.meridians
            value, zone, beside = ratio(options, pathlib.Path(folder), lon)
            ratios.append(value)
            print(f"{lon:8.2f}°  ratio {value:.4f}  RMS {zone['rms']:.3f} of {zone['pixels']} px, "
                  f"{beside['rms']:.3f} beside", flush=True)
    others = ratios[1:]
    mean, deviation = statistics.mean(others), statistics.stdev(others)
    print(f"antimeridian {ratios[0]:.4f}; others: mean {mean:.4f}, standard deviation {deviation:.4f}; "
          f"the antimeridian is {(ratios[0] - mean) / deviation:+.1f} of them away")


if __name__ == "__main__":
    main()
