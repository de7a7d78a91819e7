"""The commands and their options. Each command's work is imported only when it is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vsgraphs.cli import completion, examples
from vsgraphs.cli.failures import set_debug, told

app = typer.Typer(
    name="vsgraphs",
    help="RGB-D SLAM and 3D scene graphs: a recorded sequence becomes a map of rooms, doors and walls.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
    epilog=examples.PROGRAM,
    pretty_exceptions_enable=False,
)


_VIEW_PORT = "The viewer's port (9876 unless given); a page for browsers is one above."
_VIEW_ADDRESS = "Listen at this IP address (127.0.0.1 unless given: only this machine can look); no password."


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


@app.command(epilog=examples.RUN)
def run(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="FOLDER",
            help="A sequence: TUM, ICL-NUIM, 7-Scenes, Replica, ScanNet, OpenLORIS or Redwood/Open3D.",
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="Directory for the results; those of an earlier run in it are replaced.",
            show_default="a new ./NAME_vsgraphs, numbered",
        ),
    ] = None,
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
            help="full (default): rooms and all else; bc: walls, ground, landmarks; slam: landmarks.",
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
    view_address: Annotated[str | None, typer.Option(metavar="IP", help=_VIEW_ADDRESS)] = None,
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
    frame_timeout: Annotated[
        float,
        typer.Option(
            metavar="SECONDS",
            min=0.1,
            help="Skip a frame whose images cannot be read within this time (a network disk that stalls).",
        ),
    ] = 10.0,
    overwrite: Annotated[
        bool,
        typer.Option("--overwrite", help="Let --save-atlas replace a file that the run does not start from."),
    ] = False,
    keep: Annotated[
        int,
        typer.Option(
            min=0, help="Versions of the atlas from before the run to keep: FILE.1 (the last), FILE.2, ..."
        ),
    ] = 1,
) -> None:
    """Track a camera through a recorded sequence: trajectory, map, scene graph, floor plan."""
    from vsgraphs.cli.output import results_folder

    with told(), results_folder(out, source) as folder:
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
            out=folder,
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
            frame_timeout_s=frame_timeout,
            overwrite=overwrite,
            keep=keep,
            shortcuts={key: value for key, value in shortcuts.items() if value is not None},
            showing=Showing(view, record, view_port, web, view_address),
        )
        code = run_sequence(request)
    raise typer.Exit(code)


@app.command("eval", epilog=examples.EVAL)
def evaluate(
    trajectory: Annotated[
        Path, typer.Argument(help="Trajectory in TUM format, or the directory a run left it in.")
    ] = Path("trajectory.txt"),
    groundtruth: Annotated[
        Path | None,
        typer.Option(
            help="True trajectory (any format), or the sequence's folder. Unless given: of a run's "
            "directory the sequence it was made from; with --scene groundtruth.txt beside --truth."
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
    """Compare a run or a trajectory with the truth: ATE, RPE, completion; rooms, doors, walls where known."""
    with told():
        if scene is not None or truth is not None:
            from vsgraphs.cli.compare_scene import compare_scene, scene_request

            compare_scene(
                scene_request(scene, truth, groundtruth, max_dt, json_file, list(tolerance or []), plot)
            )
            return
        from vsgraphs.cli.compare import CompareRequest, required_truth
        from vsgraphs.cli.compare_run import compare_run

        true_path = required_truth(groundtruth, trajectory)
        compare_run(CompareRequest(trajectory, true_path, sequence, max_dt, json_file, plot))


@app.command(epilog=examples.VIEW)
def view(
    run: Annotated[Path, typer.Argument(metavar="RUN_DIR", help="Directory that `vsgraphs run` left.")],
    web: Annotated[
        bool, typer.Option("--web", help="A page for a browser also where a window could open.")
    ] = False,
    record: Annotated[
        Path | None, typer.Option(help="Write what is shown to this .rrd file; no window opens.")
    ] = None,
    view_port: Annotated[int | None, typer.Option(min=1, max=65534, help=_VIEW_PORT)] = None,
    view_address: Annotated[str | None, typer.Option(metavar="IP", help=_VIEW_ADDRESS)] = None,
) -> None:
    """Open a finished run: map, walls, rooms and the graph above them."""
    with told():
        from vsgraphs.cli.viewing import Showing, view_run

        view_run(run, Showing(record is None, record, view_port, web, view_address))


@app.command(epilog=examples.SIMULATE)
def simulate(
    plan: Annotated[
        str | None,
        typer.Argument(
            metavar="PLAN",
            help="An included plan (one_room, two_rooms, three_rooms, ...) or a JSON file.",
            autocompletion=completion.plans,
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for the sequence; must be new or empty.")
    ] = None,
    building: Annotated[
        str | None,
        typer.Option(
            metavar="KIND",
            help="Instead of PLAN, a generated building of look-alike offices: line, ring, star or storeys.",
            autocompletion=completion.chosen_from("line", "ring", "star", "storeys"),
        ),
    ] = None,
    rooms: Annotated[int | None, typer.Option(help="Offices of --building; 12 unless given.")] = None,
    furnishings: Annotated[
        int | None,
        typer.Option(help="Different furnishings of --building's offices; 1: all alike. 4 unless given."),
    ] = None,
    storeys: Annotated[
        int | None, typer.Option(help="Storeys of --building storeys; 2 unless given.")
    ] = None,
    seed: Annotated[
        int, typer.Option(help="Which draw of the sensor's noise, and of the building with --building.")
    ] = 0,
    noise_seed: Annotated[
        int | None, typer.Option(help="Draw of the noise alone, if it is not --seed's.")
    ] = None,
    plan_only: Annotated[
        Path | None,
        typer.Option("--plan-only", metavar="FILE", help="Write the plan to this file and render nothing."),
    ] = None,
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
        bool,
        typer.Option("--overwrite", help="Replace an earlier simulation in --out, or --plan-only's file."),
    ] = False,
) -> None:
    """Render a recorded sequence with exact ground truth from a plan of rooms."""
    with told():
        from vsgraphs.cli.choose_plan import PlanChoice, write_plan
        from vsgraphs.cli.make_sequence import make_sequence, out_folder
        from vsgraphs.simulate import Output

        choice = PlanChoice(plan, building, rooms, furnishings, storeys, seed)
        if plan_only is not None:
            write_plan(choice, plan_only, overwrite=overwrite, with_out=out is not None)
            return
        chosen = choice.plan()
        output = Output(
            fps=fps,
            every=every,
            image_format=image_format,
            labels_every=labels_every,
            workers=workers,
            overwrite=overwrite,
        )
        code = make_sequence(
            chosen,
            out_folder(out),
            seed=seed if noise_seed is None else noise_seed,
            noise=noise,
            frames=frames,
            output=output,
        )
    raise typer.Exit(code)


@app.command(epilog=examples.INFO)
def info(
    what: Annotated[
        Path,
        typer.Argument(metavar="RUN_DIR|ATLAS", help="A run's directory, or an atlas of `run --save-atlas`."),
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Print what a run or a saved atlas holds and what it was made with."""
    with told():
        if what.is_dir():
            from vsgraphs.cli.show_run import show_run

            show_run(what, as_json=as_json)
            return
        from vsgraphs.cli.show_atlas import show_atlas

        show_atlas(what, as_json=as_json)


@app.command(epilog=examples.CONFIG)
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
