"""The commands and their options. Each command's work is imported only when it is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vsgraphs.cli import completion, examples
from vsgraphs.cli.failures import set_debug, told
from vsgraphs.cli.run_options import VIEW_ADDRESS, VIEW_PORT, run

app = typer.Typer(
    name="vsgraphs",
    help="RGB-D SLAM and 3D scene graphs: a recorded sequence becomes a map of rooms, doors and walls.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
    epilog=examples.PROGRAM,
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


app.command(epilog=examples.RUN)(run)


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
    view_port: Annotated[int | None, typer.Option(min=1, max=65534, help=VIEW_PORT)] = None,
    view_address: Annotated[str | None, typer.Option(metavar="IP", help=VIEW_ADDRESS)] = None,
) -> None:
    """Open a finished run: map, walls, rooms and the graph above them."""
    with told():
        from vsgraphs.cli.viewing import view_run
        from vsgraphs.run import Showing

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
    drawn: Annotated[
        str | None,
        typer.Option(
            metavar="KIND",
            help="Instead of PLAN: flat or office with glass, mirrors, shut doors, people, drawn by --seed.",
            autocompletion=completion.chosen_from("flat", "office"),
        ),
    ] = None,
    robot: Annotated[
        bool, typer.Option("--robot", help="The camera of --drawn is on a robot, 0.3 m above the floor.")
    ] = False,
    rooms: Annotated[int | None, typer.Option(help="Offices of --building; 12 unless given.")] = None,
    furnishings: Annotated[
        int | None,
        typer.Option(help="Different furnishings of --building's offices; 1: all alike. 4 unless given."),
    ] = None,
    storeys: Annotated[
        int | None, typer.Option(help="Storeys of --building storeys; 2 unless given.")
    ] = None,
    seed: Annotated[
        int, typer.Option(help="Which draw of the sensor's noise, and of the building or the drawn rooms.")
    ] = 0,
    noise_seed: Annotated[
        int | None, typer.Option(help="Draw of the noise alone, if it is not --seed's.")
    ] = None,
    plan_only: Annotated[
        Path | None,
        typer.Option("--plan-only", metavar="FILE", help="Write the plan to this file and render nothing."),
    ] = None,
    noise: Annotated[
        str, typer.Option(help="sensor: as a real camera sees it; clean: exact, as --sensor clean.")
    ] = "sensor",
    sensor: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Camera: classic, clean, kinect1, kinect2, d435 or iphone_lidar; the plan's unless given.",
            autocompletion=completion.chosen_from(
                "classic", "clean", "kinect1", "kinect2", "d435", "iphone_lidar"
            ),
        ),
    ] = None,
    effect: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=VALUE",
            help="Effect of the camera, as rolling_shutter_s=0.02; repeatable. docs/simulator.md lists them.",
        ),
    ] = None,
    frames: Annotated[int | None, typer.Option(min=1, help="Write at most this many frames.")] = None,
    fps: Annotated[float | None, typer.Option(help="Frames per second, the plan's unless given.")] = None,
    every: Annotated[int, typer.Option(min=1, help="Keep only each n-th frame.")] = 1,
    image_format: Annotated[str, typer.Option(help="jpg or png, of the colour images.")] = "jpg",
    labels_every: Annotated[
        int, typer.Option(min=0, help="Class and instance images with each n-th frame; 0: none.")
    ] = 5,
    motion: Annotated[
        bool, typer.Option("--motion", help="Add imu.txt (200 Hz) and odometry.txt (wheels, 50 Hz).")
    ] = False,
    workers: Annotated[int | None, typer.Option(min=1, help="Threads; at most 4 unless given.")] = None,
    overwrite: Annotated[
        bool,
        typer.Option("--overwrite", help="Replace an earlier simulation in --out, or --plan-only's file."),
    ] = False,
) -> None:
    """Render a recorded sequence with exact ground truth from a plan of rooms."""
    with told():
        from vsgraphs.cli.choose_plan import PlanChoice, write_plan
        from vsgraphs.cli.make_sequence import Looks, make_sequence, out_folder
        from vsgraphs.simulate import Output

        choice = PlanChoice(plan, building, rooms, furnishings, storeys, seed, drawn, robot)
        if plan_only is not None:
            write_plan(choice, plan_only, overwrite=overwrite, with_out=out is not None)
            return
        chosen = choice.plan()
        output = Output(
            fps=fps,
            every=every,
            image_format=image_format,
            labels_every=labels_every,
            motion=motion,
            workers=workers,
            overwrite=overwrite,
        )
        code = make_sequence(
            chosen,
            out_folder(out),
            looks=Looks(seed if noise_seed is None else noise_seed, noise, sensor, effect or []),
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


@app.command(epilog=examples.EXPORT)
def export(
    run: Annotated[Path, typer.Argument(metavar="RUN_DIR", help="Directory that `vsgraphs run` left.")],
    names: Annotated[
        list[str],
        typer.Argument(
            metavar="NAME...",
            help="Exporters: floorplan, planes, spark-dsg, or a plug-in's (see `vsgraphs plugins`).",
            autocompletion=completion.exporters,
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Directory for the files.", show_default="RUN_DIR"),
    ] = None,
) -> None:
    """Make files from a finished run."""
    with told():
        from vsgraphs.cli.plugin_commands import export_run

        export_run(run, names, out)


@app.command("plugins")
def plugins_() -> None:
    """List sources, segmenters, exporters and checks, those of other packages too."""
    with told():
        from vsgraphs.cli.plugin_commands import list_plugins

        list_plugins()


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
