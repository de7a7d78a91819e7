"""The commands and their options. Each command's work is imported only when it is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vsgraphs.cli import completion
from vsgraphs.cli.failures import set_debug, told

app = typer.Typer(
    name="vsgraphs",
    help="RGB-D SLAM and 3D scene graphs.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
    epilog="vsgraphs run FOLDER --out results, then vsgraphs view results. "
    "vsgraphs COMMAND --help tells more.",
    pretty_exceptions_enable=False,
)


_VIEW_PORT = "The viewer's port (9876 unless given); a page for browsers is one above."


def _print_version(wanted: bool) -> None:
    if wanted:
        from vsgraphs.version import version

        print(f"vsgraphs {version()}")
        raise typer.Exit


@app.callback()
def _options(
    debug: Annotated[bool, typer.Option("--debug", help="Show the trace of unexpected errors.")] = False,
    version: Annotated[  # noqa: ARG001  (its callback does the work)
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    set_debug(on=debug)


@app.command(
    epilog="Example: vsgraphs run ~/rgbd_dataset_freiburg1_xyz --out results --view",
)
def run(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="FOLDER",
            help="A sequence: TUM, ICL-NUIM, 7-Scenes, Replica, ScanNet, OpenLORIS or Redwood/Open3D.",
        ),
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory for the results.")],
    camera: Annotated[
        str | None,
        typer.Option(
            help="camera.yaml or a known camera's name, if the folder has none.",
            autocompletion=completion.cameras,
        ),
    ] = None,
    mode: Annotated[
        str | None,
        typer.Option(
            help="slam: landmarks; bc: and walls, ground; full: and rooms (default).",
            autocompletion=completion.chosen_from("slam", "bc", "full"),
        ),
    ] = None,
    execution: Annotated[
        str | None,
        typer.Option(
            help="threaded (default), or serial: the same bytes on every run.",
            autocompletion=completion.chosen_from("threaded", "serial"),
        ),
    ] = None,
    realtime: Annotated[
        bool,
        typer.Option("--realtime", help="Pace frames by their timestamps; drop late ones like a camera."),
    ] = False,
    max_frames: Annotated[int | None, typer.Option(min=1, help="Stop after this many frames.")] = None,
    config: Annotated[Path | None, typer.Option(help="YAML file of options (see `vsgraphs config`).")] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Set one option (see `vsgraphs config`); repeatable.",
            autocompletion=completion.assignments,
        ),
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Start of all random numbers.")] = None,
    segmenter: Annotated[
        str,
        typer.Option(help="What tells surfaces apart: geometry, onnx:FILE (a network), labels:DIR (images)."),
    ] = "geometry",
    markers: Annotated[
        Path | None,
        typer.Option(help="JSON file of ArUco markers that name rooms and doors (docs/markers.md)."),
    ] = None,
    map_colours: Annotated[
        str, typer.Option(help="Of map.ply: image (as seen) or class (of the surface a point lies on).")
    ] = "image",
    schedule_out: Annotated[
        Path | None, typer.Option(help="Record what happened when in a threaded run in this file.")
    ] = None,
    replay: Annotated[Path | None, typer.Option(help="Repeat the run recorded in this file exactly.")] = None,
    view: Annotated[
        bool, typer.Option("--view", help="Watch it: a window, or without a display a page for a browser.")
    ] = False,
    record: Annotated[
        Path | None, typer.Option(help="Record what --view would show in this .rrd file.")
    ] = None,
    web: Annotated[bool, typer.Option("--web", help="As --view, always a page for a browser.")] = False,
    view_port: Annotated[int | None, typer.Option(min=1, max=65534, help=_VIEW_PORT)] = None,
    save_atlas: Annotated[
        Path | None, typer.Option(help="Save all maps in this file at the end, Ctrl-C included.")
    ] = None,
    load_atlas: Annotated[Path | None, typer.Option(help="Go on in the maps of this file.")] = None,
    localise_only: Annotated[
        bool,
        typer.Option(
            "--localise-only", help="Only locate the camera in --load-atlas; the maps stay as they are."
        ),
    ] = False,
    autosave: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS",
            min=0.1,
            max=86400,
            help="Save this often meanwhile too, in --save-atlas or atlas.vsg in --out.",
        ),
    ] = None,
) -> None:
    """Track a camera through a recorded sequence and build the map."""
    with told():
        from vsgraphs.cli.run import RunRequest, run_sequence
        from vsgraphs.cli.viewing import Showing

        shortcuts = {
            "system.mode": mode,
            "system.execution": execution,
            "system.realtime": realtime or None,
            "system.seed": seed,
            "system.schedule_out": None if schedule_out is None else str(schedule_out),
            "system.replay": None if replay is None else str(replay),
            "system.localise_only": localise_only or None,
        }
        request = RunRequest(
            source=source,
            out=out,
            camera=camera,
            max_frames=max_frames,
            segmenter=segmenter,
            map_colours=map_colours,
            markers=markers,
            config_file=config,
            assignments=list(set_ or []),
            save_atlas=save_atlas,
            load_atlas=load_atlas,
            autosave_s=autosave,
            shortcuts={key: value for key, value in shortcuts.items() if value is not None},
            showing=Showing(view, record, view_port, web),
        )
        code = run_sequence(request)
    raise typer.Exit(code)


@app.command(
    "eval",
    epilog="Example: vsgraphs eval results --groundtruth FOLDER/groundtruth.txt --plot error.png",
)
def evaluate(
    trajectory: Annotated[
        Path, typer.Argument(help="Trajectory in TUM format, or the directory a run left it in.")
    ] = Path("trajectory.txt"),
    groundtruth: Annotated[
        Path | None,
        typer.Option(
            help="True trajectory (any format), or the sequence's folder. Required; with --scene "
            "groundtruth.txt beside --truth unless given."
        ),
    ] = None,
    sequence: Annotated[
        Path | None, typer.Option(help="Folder of the input sequence, to count completion against.")
    ] = None,
    max_dt: Annotated[
        float, typer.Option(help="Largest time between an estimated and a true pose of a pair, seconds.")
    ] = 0.01,
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the figures to this file.")] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw both trajectories to this .png or .svg file.")
    ] = None,
    scene: Annotated[
        Path | None, typer.Option(help="Score the scene graph in this directory of a run instead.")
    ] = None,
    truth: Annotated[Path | None, typer.Option(help="scene_gt.json, with --scene.")] = None,
    tolerance: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=VALUE", help="Another tolerance of --scene, as offset_m=0.1; repeatable."),
    ] = None,
) -> None:
    """Compare a trajectory (ATE, RPE, completion) or a scene graph (--scene, --truth) with the truth."""
    with told():
        if scene is not None or truth is not None:
            from vsgraphs.cli.compare_scene import compare_scene, scene_request

            compare_scene(
                scene_request(scene, truth, groundtruth, max_dt, json_file, list(tolerance or []), plot)
            )
            return
        from vsgraphs.cli.compare import CompareRequest, compare, required_truth

        compare(CompareRequest(trajectory, required_truth(groundtruth), sequence, max_dt, json_file, plot))


@app.command(epilog="Example: vsgraphs view results")
def view(
    run: Annotated[
        Path, typer.Argument(metavar="RUN_DIR", help="Directory that `vsgraphs run --out` wrote.")
    ],
    web: Annotated[
        bool, typer.Option("--web", help="A page for a browser also where a window could open.")
    ] = False,
    record: Annotated[
        Path | None, typer.Option(help="Write what is shown to this .rrd file; no window opens.")
    ] = None,
    view_port: Annotated[int | None, typer.Option(min=1, max=65534, help=_VIEW_PORT)] = None,
) -> None:
    """Open a finished run: map, walls, rooms and the graph above them."""
    with told():
        from vsgraphs.cli.viewing import Showing, view_run

        view_run(run, Showing(record is None, record, view_port, web))


@app.command(
    epilog="Example: vsgraphs simulate two_rooms --out sequence --every 3, then "
    "vsgraphs run sequence --out results",
)
def simulate(
    plan: Annotated[
        str,
        typer.Argument(
            metavar="PLAN",
            help="An included plan (one_room, two_rooms, three_rooms, ...) or a JSON file.",
            autocompletion=completion.plans,
        ),
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the sequence; must be new or empty.")],
    seed: Annotated[int, typer.Option(help="Which draw of the sensor's noise.")] = 0,
    noise: Annotated[str, typer.Option(help="sensor: as a real camera sees it; clean: exact.")] = "sensor",
    frames: Annotated[int | None, typer.Option(min=1, help="Write at most this many frames.")] = None,
    fps: Annotated[float | None, typer.Option(help="Frames per second, the plan's unless given.")] = None,
    every: Annotated[int, typer.Option(min=1, help="Keep only each n-th frame.")] = 1,
    image_format: Annotated[str, typer.Option(help="jpg or png, of the colour images.")] = "jpg",
    labels_every: Annotated[
        int, typer.Option(min=0, help="Class and instance images with each n-th frame; 0: none.")
    ] = 5,
    workers: Annotated[int | None, typer.Option(min=1, help="Threads; at most 4 unless given.")] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace an earlier simulation in --out.")
    ] = False,
) -> None:
    """Render a recorded sequence with exact ground truth from a plan of rooms."""
    with told():
        from vsgraphs.cli.make_sequence import make_sequence
        from vsgraphs.simulate import Output

        output = Output(
            fps=fps,
            every=every,
            image_format=image_format,
            labels_every=labels_every,
            workers=workers,
            overwrite=overwrite,
        )
        code = make_sequence(plan, out, seed=seed, noise=noise, frames=frames, output=output)
    raise typer.Exit(code)


@app.command()
def info(
    file: Annotated[Path, typer.Argument(help="An atlas that `run --save-atlas` left.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Print what a saved atlas holds and what it was made with."""
    with told():
        from vsgraphs.cli.show_atlas import show_atlas

        show_atlas(file, as_json=as_json)


@app.command(
    epilog="Examples: vsgraphs config tracker; vsgraphs config explain orb.max_features; "
    "vsgraphs config --yaml > mine.yaml",
)
def config(
    search: Annotated[
        str | None,
        typer.Argument(
            help="Only options whose key contains this; or the word `explain`, then a key.",
            autocompletion=completion.config_words,
        ),
    ] = None,
    key: Annotated[
        str | None,
        typer.Argument(
            help="After `explain`: the option to tell all about.", autocompletion=completion.option_keys
        ),
    ] = None,
    as_yaml: Annotated[bool, typer.Option("--yaml", help="Print a file that `run --config` reads.")] = False,
    as_schema: Annotated[
        bool, typer.Option("--schema", help="Print the JSON schema of such files, for editors.")
    ] = False,
) -> None:
    """Print every option: key, default, unit, range, meaning."""
    with told():
        from vsgraphs.cli.show_config import explain, show_config
        from vsgraphs.errors import InputError

        if key is not None and search != "explain":
            raise InputError(f"config {search} {key}: give one word to search for, or `explain KEY`")
        if search == "explain":
            if key is None:
                raise InputError("config explain: which option? `vsgraphs config` lists all keys")
            explain(key)
            return
        show_config(search, as_yaml=as_yaml, as_schema=as_schema)
