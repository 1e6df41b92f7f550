"""Earthquakes of a week under a translucent Earth. Each block is a cell of a notebook; `# %%` begins one.

    PYTHONPATH=build/python python3 apps/examples/earthquakes.py data/points/earthquakes.geojson quakes.png
"""

# %% The Earth that comes with Terrella, without a display and without a GPU
import json
import sys

import terrella

catalogue, picture_file = sys.argv[1:3]
globe = terrella.Globe(size=(900, 600), camera=(-15, 170, 9e6), surface_alpha=0.55)

# %% The strongest earthquakes alone, from the catalogue of the US Geological Survey
quakes = json.load(open(catalogue, encoding="utf-8"))
quakes["features"] = [quake for quake in quakes["features"] if (quake["properties"]["mag"] or 0) >= 4.5]
layer = globe.add_objects(quakes)
picture = globe.render()  # height x width x 3 bytes: matplotlib's imshow() or PIL's Image.fromarray() shows it
print(f"{len(quakes['features'])} earthquakes, {picture.shape[1]} x {picture.shape[0]} pixels")

# %% The place under the middle of the picture, and the nearest earthquake's
under = globe.pick(picture.shape[1] / 2, picture.shape[0] / 2)
print("the middle shows", under["place"])

# %% The same view as a file
terrella.render(size=(900, 600), camera=globe.camera, surface_alpha=0.55, objects=catalogue, output=picture_file)
