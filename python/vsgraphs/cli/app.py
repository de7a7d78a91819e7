"""The commands and their options. Each command's work is imported only when it is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vsgraphs.cli import completion, examples
from vsgraphs.cli.failures import set_debug, told
from vsgraphs.cli.run_options import VIEW_ADDRESS, VIEW_PORT, run
from vsgraphs.cli.simulate_options import simulate

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
        Path | None,
        typer.Option(help="Folder of the input sequence, whose frames completion is counted against."),
    ] = None,
    max_dt: Annotated[
        float, typer.Option(help="Largest time between an estimated pose and its true pose, in seconds.")
    ] = 0.01,
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the figures to this file.")] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw both trajectories to this .png or .svg file.")
    ] = None,
    scene: Annotated[
        Path | None, typer.Option(help="Score the scene graph in this directory of a run instead.")
    ] = None,
    truth: Annotated[
        Path | None, typer.Option(help="True scene (scene_gt.json) that --scene is scored against.")
    ] = None,
    tolerance: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=VALUE", help="Tolerance of --scene to change, as offset_m=0.1; repeatable."
        ),
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
        bool, typer.Option("--web", help="Show the run in a browser page even where a window could open.")
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


app.command(epilog=examples.SIMULATE)(simulate)


@app.command(epilog=examples.INFO)
def info(
    what: Annotated[
        Path,
        typer.Argument(metavar="RUN_DIR|ATLAS", help="A run's directory, or an atlas of `run --save-atlas`."),
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print the answer as JSON.")] = False,
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
            help="Show only options whose key contains this text; or the word `explain`, then a key.",
            autocompletion=completion.config_words,
        ),
    ] = None,
    key: Annotated[
        str | None,
        typer.Argument(
            help="After `explain`: the key of the option to explain.", autocompletion=completion.option_keys
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
