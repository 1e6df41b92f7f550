"""Types of the module terrella. help(terrella.render) describes each option; the test python.stubs compares."""

import os
from typing import Any, Literal

import numpy
import numpy.typing

__all__ = ["Error", "Globe", "IncompleteWarning", "__version__", "cut", "info", "merge", "preload", "render"]
__version__: str

_Path = str | os.PathLike[str]
_Picture = numpy.typing.NDArray[numpy.uint8]

class Error(RuntimeError): ...
class IncompleteWarning(UserWarning): ...

def render(
    tileset: _Path | None = ...,
    *,
    camera: str | tuple[float, ...] | None = ...,
    size: str | tuple[int, int] | None = ...,
    body: str | tuple[float, ...] | None = ...,
    projection: Literal["equirectangular", "equal-area", "web-mercator"] | None = ...,
    latitude: Literal["graphic", "centric"] | None = ...,
    crs: str | None = ...,
    bounds: str | tuple[float, ...] | None = ...,
    west: float | None = ...,
    band: int | None = ...,
    bands: str | tuple[int, ...] | None = ...,
    stretch: str | tuple[float, ...] | None = ...,
    colormap: _Path | None = ...,
    nodata: float | None = ...,
    unlit: bool = ...,
    texturing: Literal["vertex", "paper", "exact", "auto"] | None = ...,
    paper_a: float | None = ...,
    polar_rows: Literal["squeezed", "full"] | None = ...,
    polar_columns: int | None = ...,
    detail: float | None = ...,
    magnify: Literal["bilinear", "bicubic", "auto"] | None = ...,
    depth: Literal["reversed", "log", "standard"] | None = ...,
    overlay: _Path | list[_Path] | None = ...,
    overlay_projection: Literal["equirectangular", "equal-area", "web-mercator"] | None = ...,
    night: _Path | None = ...,
    clouds: _Path | None = ...,
    cloud_height: float | None = ...,
    elevation: _Path | None = ...,
    elevation_encoding: Literal["terrain-rgb", "terrarium"] | None = ...,
    exaggeration: float | None = ...,
    hillshade: bool = ...,
    surface_alpha: float | None = ...,
    blend: Literal["normal", "additive"] | None = ...,
    inner_sphere: float | str | None = ...,
    inner_sphere_color: str | None = ...,
    surface_from_below: Literal["opaque", "translucent", "selective"] | None = ...,
    horizon_culling: Literal["on", "off", "auto"] | None = ...,
    sky: bool | None = ...,
    glint: bool | None = ...,
    time: str | None = ...,
    objects: _Path | None = ...,
    map: bool | None = ...,
    places: _Path | None = ...,
    stereo: Literal["off", "side-by-side", "interlaced", "anaglyph"] | None = ...,
    eye_separation: float | None = ...,
    cache: _Path | None = ...,
    cache_size: int | None = ...,
    memory: int | None = ...,
    offline: bool = ...,
    layer: str | None = ...,
    matrix_set: str | None = ...,
    style: str | None = ...,
    layer_time: str | None = ...,
    root_span: float | None = ...,
    tile_size: int | None = ...,
    max_level: int | None = ...,
    header: str | list[str] | None = ...,
    output: _Path | None = ...,
    timeout: float | None = ...,
    legend: bool = ...,
    graticule: bool = ...,
    credits: bool = ...,
) -> _Picture: ...

def cut(
    image: _Path | list[_Path],
    *,
    output: _Path,
    tile_size: int | None = ...,
    quality: int | None = ...,
    format: Literal["jpg", "png", "webp"] | None = ...,
    crs: str | None = ...,
    bounds: str | tuple[float, ...] | None = ...,
    west: float | None = ...,
    mosaic: str | tuple[int, int] | None = ...,
    elevation: bool = ...,
    scale: float | None = ...,
    offset: float | None = ...,
    nodata: float | None = ...,
    band: int | None = ...,
    bands: str | tuple[int, ...] | None = ...,
    stretch: str | tuple[float, ...] | None = ...,
    body: str | tuple[float, ...] | None = ...,
    projection: Literal["equirectangular", "equal-area"] | None = ...,
    latitude: Literal["graphic", "centric"] | None = ...,
    name: str | None = ...,
    attribution: str | None = ...,
    jobs: int | None = ...,
    shard: str | tuple[int, int] | None = ...,
    join: bool = ...,
    force: bool = ...,
) -> dict[str, Any]: ...

def preload(
    source: _Path,
    *,
    output: _Path,
    levels: str | tuple[int, int] | None = ...,
    bbox: str | tuple[float, ...] | list[str | tuple[float, ...]] | None = ...,
    polygon: _Path | list[_Path] | None = ...,
    flight: _Path | None = ...,
    size: str | tuple[int, int] | None = ...,
    shard: str | tuple[int, int] | None = ...,
    layer: str | None = ...,
    matrix_set: str | None = ...,
    style: str | None = ...,
    layer_time: str | None = ...,
    root_span: float | None = ...,
    tile_size: int | None = ...,
    max_level: int | None = ...,
    header: str | list[str] | None = ...,
    projection: Literal["equirectangular", "equal-area", "web-mercator"] | None = ...,
    jobs: int | None = ...,
    rate: float | None = ...,
    timeout: float | None = ...,
    retries: int | None = ...,
    refresh_older_than: float | None = ...,
    ca_file: _Path | None = ...,
    cache_size: int | None = ...,
    missing: _Path | None = ...,
    stored: _Path | None = ...,
    dry_run: bool = ...,
    release: bool = ...,
    offline: bool = ...,
) -> dict[str, Any]: ...

def info(
    tileset: _Path,
    *,
    crs: str | None = ...,
    bounds: str | tuple[float, ...] | None = ...,
    west: float | None = ...,
    band: int | None = ...,
    nodata: float | None = ...,
    verify: bool = ...,
    timeout: float | None = ...,
) -> dict[str, Any]: ...

def merge(
    cache: _Path | list[_Path],
    *,
    output: _Path,
) -> dict[str, Any]: ...

class Globe:
    def __init__(
        self,
        tileset: _Path | None = ...,
        *,
        camera: str | tuple[float, ...] | None = ...,
        size: str | tuple[int, int] | None = ...,
        body: str | tuple[float, ...] | None = ...,
        projection: Literal["equirectangular", "equal-area", "web-mercator"] | None = ...,
        latitude: Literal["graphic", "centric"] | None = ...,
        crs: str | None = ...,
        bounds: str | tuple[float, ...] | None = ...,
        west: float | None = ...,
        band: int | None = ...,
        bands: str | tuple[int, ...] | None = ...,
        stretch: str | tuple[float, ...] | None = ...,
        colormap: _Path | None = ...,
        nodata: float | None = ...,
        unlit: bool = ...,
        texturing: Literal["vertex", "paper", "exact", "auto"] | None = ...,
        paper_a: float | None = ...,
        polar_rows: Literal["squeezed", "full"] | None = ...,
        polar_columns: int | None = ...,
        detail: float | None = ...,
        magnify: Literal["bilinear", "bicubic", "auto"] | None = ...,
        depth: Literal["reversed", "log", "standard"] | None = ...,
        overlay: _Path | list[_Path] | None = ...,
        overlay_projection: Literal["equirectangular", "equal-area", "web-mercator"] | None = ...,
        night: _Path | None = ...,
        clouds: _Path | None = ...,
        cloud_height: float | None = ...,
        elevation: _Path | None = ...,
        elevation_encoding: Literal["terrain-rgb", "terrarium"] | None = ...,
        exaggeration: float | None = ...,
        hillshade: bool = ...,
        surface_alpha: float | None = ...,
        blend: Literal["normal", "additive"] | None = ...,
        inner_sphere: float | str | None = ...,
        inner_sphere_color: str | None = ...,
        surface_from_below: Literal["opaque", "translucent", "selective"] | None = ...,
        horizon_culling: Literal["on", "off", "auto"] | None = ...,
        sky: bool | None = ...,
        glint: bool | None = ...,
        time: str | None = ...,
        objects: _Path | None = ...,
        map: bool | None = ...,
        places: _Path | None = ...,
        stereo: Literal["off", "side-by-side", "interlaced", "anaglyph"] | None = ...,
        eye_separation: float | None = ...,
        cache: _Path | None = ...,
        cache_size: int | None = ...,
        memory: int | None = ...,
        offline: bool = ...,
        layer: str | None = ...,
        matrix_set: str | None = ...,
        style: str | None = ...,
        layer_time: str | None = ...,
        root_span: float | None = ...,
        tile_size: int | None = ...,
        max_level: int | None = ...,
        header: str | list[str] | None = ...,
        timeout: float | None = ...,
        legend: bool = ...,
        graticule: bool = ...,
        credits: bool = ...,
    ) -> None: ...
    def render(self) -> _Picture: ...
    def close(self) -> None: ...
    def __enter__(self) -> Globe: ...
    def __exit__(self, *args: object) -> None: ...
    @property
    def camera(self) -> tuple[float, float, float, float, float, float]: ...
    @camera.setter
    def camera(self, value: str | tuple[float, ...]) -> None: ...
    @property
    def size(self) -> tuple[int, int]: ...
    @property
    def imagery(self) -> list[int]: ...
    @property
    def objects(self) -> list[int]: ...
    @property
    def attributions(self) -> list[str]: ...
    def add_imagery(self, tileset: _Path, opacity: float = ...) -> int: ...
    def add_objects(self, geojson: object) -> int: ...
    def set_objects(self, layer: int, geojson: object) -> None: ...
    def move(self, layer: int, id: int, lat: float, lon: float, height: float = ..., heading: float | None = ...) -> None: ...
    def show(self, layer: int, shown: bool = ...) -> None: ...
    def set_opacity(self, layer: int, opacity: float) -> None: ...
    def remove(self, layer: int) -> None: ...
    def pick(self, x: float, y: float) -> dict[str, Any]: ...
    def project(self, lat: float, lon: float, height: float = ...) -> tuple[float, float] | None: ...
    def ground_height(self, lat: float, lon: float) -> float: ...
    def value_at(self, layer: int, lat: float, lon: float) -> float | None: ...
