"""The commands and their options. Each command's work is imported only when it is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vsgraphs.cli.failures import set_debug, told

app = typer.Typer(
    name="vsgraphs",
    help="RGB-D SLAM and 3D scene graphs.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


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


@app.command()
def run(
    source: Annotated[
        Path, typer.Argument(help="Folder of the sequence (TUM, ICL-NUIM, 7-Scenes, Replica).")
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory for the results.")],
    camera: Annotated[
        str | None, typer.Option(help="camera.yaml or a known camera's name, if the folder has none.")
    ] = None,
    mode: Annotated[
        str | None, typer.Option(help="slam: landmarks; bc: and walls, ground; full: and rooms (default).")
    ] = None,
    execution: Annotated[str | None, typer.Option(help="threaded (default) or serial.")] = None,
    realtime: Annotated[
        bool,
        typer.Option("--realtime", help="Pace frames by their timestamps; drop late ones like a camera."),
    ] = False,
    max_frames: Annotated[int | None, typer.Option(min=1, help="Stop after this many frames.")] = None,
    config: Annotated[Path | None, typer.Option(help="YAML file of options (see `vsgraphs config`).")] = None,
    set_: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Set one option; repeatable.")
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Start of all random numbers.")] = None,
    segmenter: Annotated[
        str, typer.Option(help="What tells surfaces apart: geometry, onnx:FILE, labels:DIR.")
    ] = "geometry",
    map_colours: Annotated[
        str, typer.Option(help="Of map.ply: image (as seen) or class (of the surface a point lies on).")
    ] = "image",
    schedule_out: Annotated[
        Path | None, typer.Option(help="Record what happened when in a threaded run in this file.")
    ] = None,
    replay: Annotated[Path | None, typer.Option(help="Repeat the run recorded in this file exactly.")] = None,
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
            help="Save this often meanwhile too, in --save-atlas or atlas.vsg in --out.",
        ),
    ] = None,
) -> None:
    """Track a camera through a recorded sequence and build the map."""
    with told():
        from vsgraphs.cli.run import RunRequest, run_sequence

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
            config_file=config,
            assignments=list(set_ or []),
            save_atlas=save_atlas,
            load_atlas=load_atlas,
            autosave_s=autosave,
            shortcuts={key: value for key, value in shortcuts.items() if value is not None},
        )
        code = run_sequence(request)
    raise typer.Exit(code)


@app.command("eval")
def evaluate(
    trajectory: Annotated[
        Path, typer.Argument(help="Trajectory in TUM format, or the directory a run left it in.")
    ] = Path("trajectory.txt"),
    groundtruth: Annotated[
        Path | None,
        typer.Option(
            help="True trajectory (TUM, ICL-NUIM, Replica), or the sequence's folder. Required; with --scene "
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


@app.command()
def simulate(
    plan: Annotated[str, typer.Argument(help="An included plan's name or a JSON file.")],
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


@app.command()
def config(
    search: Annotated[str | None, typer.Argument(help="Show only options whose key contains this.")] = None,
    as_yaml: Annotated[bool, typer.Option("--yaml", help="Print a file that `run --config` reads.")] = False,
) -> None:
    """Print every option: key, default, range, meaning."""
    with told():
        from vsgraphs.cli.show_config import show_config

        show_config(search, as_yaml=as_yaml)
