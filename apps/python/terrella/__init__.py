"""Globes for notebooks and scripts: pictures as numpy arrays, without a display and without a GPU.

    import terrella
    picture = terrella.render(camera=(46, 7, 3e6), size=(800, 600))

render, film, cut, preload, info, merge, convert and purge take the options of the commands of the same names:
--surface-alpha is surface_alpha. Angles are degrees, lengths are metres.
"""

from terrella._terrella import (
    Error, Globe, IncompleteWarning, __version__, convert, cut, film, info, merge, preload, purge, render)

__all__ = ["Error", "Globe", "IncompleteWarning", "__version__", "convert", "cut", "film", "info", "merge", "preload",
           "purge", "render"]
