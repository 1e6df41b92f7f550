#!/usr/bin/env python3
"""Plants faults in a copy of the source, one after another, and shows that tests notice each fault.

Example:  tests/mutation/planted_faults.py --work /tmp/faults
          tests/mutation/planted_faults.py --only asin
          tests/mutation/planted_faults.py --check

The copy is first built without a fault, and its tests must pass. Then each fault is planted, its test program is built
again and must fail, and the fault is removed. A run takes some minutes on two cores. Exit code 0: every fault was
noticed; 1: a fault was not noticed, or the copy without faults fails. --check builds nothing and checks quickly that each
fault still has its place in the source.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import typing


class Fault(typing.NamedTuple):
    name: str  # fault in words
    file: str  # file that gets the fault
    right: str  # text of the file, found once
    wrong: str  # text that replaces it
    program: str  # the test program that must fail …
    tests: str  # … when it runs these (GoogleTest's filter)


FAULTS = [
    Fault("float where double belongs: a vertex's low part is lost", "engine/geo/split_position.cpp",
          "return {high, glm::vec3(p_m - glm::dvec3(high))};", "return {high, glm::vec3(0.0F)};",
          "stability_tests", "Stability.NoVertexJitters*"),
    Fault("float where double belongs: the eye's low part is lost", "engine/render/frame_camera.cpp",
          "block.eye_low_ecef = glm::vec4(eye.low, 0.0F);", "block.eye_low_ecef = glm::vec4(0.0F);",
          "stability_tests", "Stability.NoVertexJitters*"),
    Fault("float where double belongs: tile coordinates", "engine/tiles/tile_grid.cpp",
          "return {.x = (lon_deg - grid.west_deg) / span,", "return {.x = static_cast<float>(lon_deg - grid.west_deg) / span,",
          "stability_tests", "Stability.WindowPointsAreRight*"),
    Fault("wrong seam side: longitudes do not unwrap around the patch", "engine/surface/patch_tree.cpp",
          "return deg - 360.0 * std::round(deg / 360.0);", "return deg;",
          "patch_tests", "PatchMesh.LongitudesUnwrap*"),
    Fault("wrong seam side: the antimeridian is -180 degrees", "engine/geo/ellipsoid.cpp",
          "return Angle::radians(lon <= -std::numbers::pi ? std::numbers::pi : lon);", "return Angle::radians(lon);",
          "terrella_geo_tests", "Ellipsoid.Antimeridian*"),
    Fault("unclamped asin: latitude from the sine of a normal", "engine/geo/ellipsoid.cpp",
          "std::atan2(n.z, std::hypot(n.x, n.y))", "std::asin(n.z)",
          "terrella_geo_tests", "Ellipsoid.*:Camera.*"),
    Fault("unclamped asin: the tilt of an eye that looks straight down", "engine/view/orbit.cpp",
          "std::clamp(-glm::dot(view.forward, normal), -1.0, 1.0)", "-glm::dot(view.forward, normal)",
          "scene_tests", "Orbit.*"),
    Fault("a grazing ray by the textbook's discriminant", "engine/geo/ellipsoid.cpp",
          ".discriminant = a * (1.0 - glm::dot(closest, closest))}",
          ".discriminant = b * b - a * (glm::dot(origin, origin) - 1.0) + 0.0 * glm::dot(closest, closest)}",
          "terrella_geo_tests", "Ray.*"),
    Fault("the near plane by the height alone", "engine/render/globe_sight.cpp",
          "std::min(0.1, 0.9 * cos_corner)", "std::min(0.1, 1.0 + 0.9 * cos_corner)",
          "render_tests", "GlobeCoverage.TheNearPlane*"),
    Fault("no fall-back: coarse functions are taken for good ones", "engine/render/gl/shader_functions.cpp",
          "<= kMostFunctionError;", "<= 1.0;",
          "stability_tests", "ShaderFunctions.*"),
    Fault("standard depth in place of reversed", "shaders/frame.glsl",
          "  return clip_scale.z;\n#else\n  return (w - clip_scale.z)",
          "  return w - clip_scale.z * w / 1e7;\n#else\n  return (w - clip_scale.z)",
          "stability_tests", "Stability.ReversedDepth*"),
    Fault("relief: the vertex's height is not exaggerated, its bounds are", "engine/surface/relief.cpp",
          "relief.heights_m.push_back(exaggeration_ * ground", "relief.heights_m.push_back(ground",
          "render_tests", "GlobeRelief.MountainsStand*"),
    Fault("relief: slopes towards the north fall where the ground rises", "engine/surface/height_slopes.cpp",
          "derivative(h[x + 2 * width], h[x + width], h[x - width], h[x - 2 * width])",
          "derivative(h[x - 2 * width], h[x - width], h[x + width], h[x + 2 * width])",
          "scene_tests", "HeightSlopes.*"),
    Fault("translucency: the surface is drawn without regard to its own depth", "engine/render/globe_renderer.h",
          "kSameDepth{.test = GL_EQUAL,", "kSameDepth{.test = GL_ALWAYS,",
          "render_tests", "GlobeRelief.ThroughATranslucent*"),
    Fault("stereo: the eyes' pictures are sheared the wrong way", "engine/view/stereo.cpp",
          "view.shear_x -= right_m / convergence_m;", "view.shear_x += right_m / convergence_m;",
          "render_tests", "GlobeStereo.*"),
    Fault("small spheres: the farther one wins", "shaders/objects/object_sphere_point.frag",
          "draw_sphere(disc, disc_w.z + dot(disc_w.xy, disc))", "draw_sphere(disc, 1.0e14 / disc_w.z)",
          "object_tests", "ObjectPassTest.OfSmallSpheres*"),
    Fault("glass: the faces towards the eye first", "engine/render/objects/mesh_pass.cpp",
          "{GL_FRONT, GL_BACK}", "{GL_BACK, GL_FRONT}",
          "mesh_tests", "MeshPassTest.Glass*"),
    Fault("request desk: the least wanted tile comes first", "engine/tiles/request_desk.cpp",
          "entry.wish.priority > best->second.wish.priority", "entry.wish.priority < best->second.wish.priority",
          "terrella_streaming_tests", "RequestDesk.TheMostWanted*"),
    Fault("request desk: a wish ends while a thread works on it", "engine/tiles/request_desk.cpp",
          "if (!removed.in_work && parts_.ended)", "if (parts_.ended)",
          "terrella_streaming_tests", "RequestDesk.ACancelledWish*"),
    Fault("preload: what was preloaded is evicted like any tile", "streaming/cache/cache_rows.cpp",
          "SELECT id, used FROM terrella_cache_tiles WHERE used IS NOT NULL ORDER BY", "SELECT id, used FROM terrella_cache_tiles ORDER BY",
          "terrella_cache_tests", "CacheLimit.Pinned*"),
    Fault("refresh: a missing tile replaces a stored tile", "streaming/cache/cache_rows.cpp",
          "if (*there)\n    return *record.missing ==", "if (*there && !record.missing)\n    return *record.missing ==",
          "terrella_cache_tests", "Cache.NoMissing*"),
    Fault("secrets: values of a query are shown", "streaming/url.cpp",
          'std::string(name) + "=" + kHidden', "std::string(parameter)",
          "terrella_remote_tests", "Url.*"),
    Fault("headers: another port of the host gets them too", "streaming/remote/describe_remote.cpp",
          "return from && to && from->origin == to->origin;",
          "return from && to && from->origin.substr(0, from->origin.rfind(':')) == to->origin.substr(0, to->origin.rfind(':'));",
          "terrella_remote_tests", "DescribeRemote.HeadersStay*"),
    Fault("retry: a tile that failed for now is missing for good", "engine/globe/tile_stream.h",
          "const bool for_now = failure.kind == MissingKind::failed;", "const bool for_now = false;",
          "facade_tests", "TileLife*"),
    Fault("objects: a change of colour cuts an area anew", "engine/objects/layer_cuts.cpp",
          "if ((!fill || area.asked_fill) && (!outline || area.asked_outline)) return;", "",
          "facade_tests", "LivingObjects.OnlyAShape*"),
    Fault("threads: a map that a further thread cannot open makes a transparent tile", "streaming/warp/map/ground_map.cpp",
          "if (!opened) return TileFailure{MissingKind::failed,", "if (!opened) return TileFailure{MissingKind::blank,",
          "terrella_warp_tests", "MapsOfThreads.*"),
    Fault("caches: a span that does not decode is kept", "streaming/remote_tiff/span_fetcher.cpp",
          "if (Status good = span.check(span.range, bytes); !good) {", "if (Status good = span.check(span.range, bytes); !good && bytes.empty()) {",
          "terrella_remote_tiff_tests", "SpanFetcherTest.ASpanThatDoesNot*"),
    Fault("archives: a damaged leaf counts as read", "streaming/pmtiles/pmtiles_index.cpp",
          "if (!parsed) return parsed.error();", "if (!parsed) return Done{};",
          "terrella_containers_tests", "PmtilesIndexTest.NothingIsKept*"),
    Fault("window: a slow action does not wait until its message is shown", "apps/viewer/parts/messages.cpp",
          "act_ = std::move(act);", "act_ = std::move(act);\n  act_shown_ = true;",
          "viewer_tests", "Messages.*"),
    Fault("anaglyph: the texts of one eye cover those of the other", "apps/viewer/panels/over_globe.cpp",
          "limit_channels(list, part.channels);", "limit_channels(list, kAllChannels);",
          "viewer_tests", "Sizes/PanelBoxes.AnEye*"),
]


def misplaced(source: pathlib.Path, fault: Fault) -> str:
    """Reason why the fault cannot be planted; empty if it can."""
    file = source / fault.file
    if not file.is_file():
        return f"there is no {fault.file}"
    count = file.read_text().count(fault.right)
    return "" if count == 1 else f"its text is {count} times in {fault.file}, not once: {fault.right}"


def run(words, **more) -> subprocess.CompletedProcess:
    return subprocess.run([str(w) for w in words], text=True, capture_output=True, check=False, **more)


def copy_source(source: pathlib.Path, copy: pathlib.Path) -> None:
    files = run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=source).stdout
    for name in filter(None, files.split("\0")):
        if not (source / name).is_file():
            continue
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source / name, copy / name)


def configure(copy: pathlib.Path, options: list[str]) -> None:
    words = ["cmake", "-S", copy, "-B", copy / "build", "-G", "Ninja"]
    if shutil.which("ccache"):
        words.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    words += [f"-D{option}" for option in options]
    result = run(words)
    if result.returncode != 0:
        sys.exit(f"{copy} cannot be configured:\n{result.stdout}{result.stderr}")


def build(copy: pathlib.Path, program: str, jobs: int) -> str:
    """Empty if it builds."""
    result = run(["ninja", "-C", copy / "build", f"-j{jobs}", program])
    return "" if result.returncode == 0 else result.stdout[-2000:]


def failed_tests(copy: pathlib.Path, program: str, tests: str) -> list[str] | None:
    """Names of the tests that fail; none at all where the program dies before it says which."""
    found = list((copy / "build").rglob(program))
    result = run([next(p for p in found if p.is_file()), f"--gtest_filter={tests}", "--gtest_brief=1"], timeout=600)
    names = [line.split("]")[1].split()[0].rstrip(",") for line in result.stdout.splitlines() if line.startswith("[  FAILED  ] ")]
    names = list(dict.fromkeys(name for name in names if "." in name))
    return names if names or result.returncode == 0 else ["(ended with code %d)" % result.returncode]


def check_without_fault(copy: pathlib.Path, faults: list[Fault], jobs: int) -> bool:
    sound = True
    for program in sorted({fault.program for fault in faults}):
        if why := build(copy, program, jobs):
            sys.exit(f"{program} does not build without a fault:\n{why}")
        filters = ":".join(fault.tests for fault in faults if fault.program == program)
        if failed := failed_tests(copy, program, filters):
            print(f"without a fault {program} fails: {', '.join(failed)}")
            sound = False
    return sound


def plant(copy: pathlib.Path, fault: Fault, jobs: int) -> bool:
    file = copy / fault.file
    if why := misplaced(copy, fault):
        print(f"NOT PLANTED  {fault.name}: {why}")
        return False
    sound = file.read_text()
    file.write_text(sound.replace(fault.right, fault.wrong))
    try:
        if why := build(copy, fault.program, jobs):
            print(f"NOT BUILT    {fault.name}:\n{why}")
            return False
        failed = failed_tests(copy, fault.program, fault.tests)
    finally:
        file.write_text(sound)
    print(f"{'noticed' if failed else 'NOT NOTICED':12} {fault.name}" + (f": {', '.join(failed[:3])}" if failed else ""))
    return bool(failed)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, help="folder for the copy and its build, kept (default: one that goes)")
    parser.add_argument("--only", default="", help="only faults with this in their name")
    parser.add_argument("--check", action="store_true", help="only say if each fault's text is in its file, once")
    parser.add_argument("--cmake", action="append", default=[], metavar="NAME=VALUE", help="an option of the build")
    parser.add_argument("--jobs", type=int, default=2, help="compilers at once")
    arguments = parser.parse_args()
    faults = [fault for fault in FAULTS if arguments.only in fault.name]
    source = pathlib.Path(__file__).resolve().parents[2]
    if arguments.check:
        wrong = [f"{fault.name}: {why}" for fault in faults if (why := misplaced(source, fault))]
        print("\n".join(wrong) or f"each of {len(faults)} faults has its place")
        return 1 if wrong else 0
    with tempfile.TemporaryDirectory(prefix="terrella-faults-") as temporary:
        copy = arguments.work or pathlib.Path(temporary)
        copy_source(source, copy)
        configure(copy, arguments.cmake)
        if not check_without_fault(copy, faults, arguments.jobs):
            return 1
        noticed = [plant(copy, fault, arguments.jobs) for fault in faults]
    print(f"{sum(noticed)} of {len(noticed)} faults were noticed")
    return 0 if all(noticed) else 1


if __name__ == "__main__":
    sys.exit(main())
