"""`vsgraphs run` on the command line: its options, and what becomes of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vsgraphs.cli import completion
from vsgraphs.cli.failures import told

VIEW_PORT = "The viewer's port (9876 unless given); a page for browsers is one above."
VIEW_ADDRESS = "Listen at this IP address (127.0.0.1 unless given: only this machine can look); no password."


def run(
    source: Annotated[
        str,
        typer.Argument(
            metavar="FOLDER",
            help="A sequence: TUM, ICL-NUIM, 7-Scenes, Replica, ScanNet, OpenLORIS or Redwood/Open3D; "
            "or NAME:TEXT, a plug-in's source.",
            autocompletion=completion.sources,
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
    every: Annotated[int, typer.Option(min=1, help="Process only every n-th frame.")] = 1,
    max_frames: Annotated[int | None, typer.Option(min=1, help="Stop after this number of frames.")] = None,
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
    seed: Annotated[int | None, typer.Option(help="Seed of all random numbers.")] = None,
    segmenter: Annotated[
        str,
        typer.Option(
            help="What classifies surfaces: geometry, onnx:FILE (a network), labels:DIR (images), "
            "source (labels that come with the frames)."
        ),
    ] = "geometry",
    markers: Annotated[
        Path | None,
        typer.Option(help="JSON file of ArUco markers that name rooms and doors (docs/markers.md)."),
    ] = None,
    map_colours: Annotated[
        str, typer.Option(help="Colours of map.ply: image (as seen) or class (of each point's surface).")
    ] = "image",
    export: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Also write the files of this exporter (see `vsgraphs plugins`); repeatable.",
            autocompletion=completion.exporters,
        ),
    ] = None,
    schedule_out: Annotated[
        Path | None, typer.Option(help="File to record a threaded run's order of steps in, for --replay.")
    ] = None,
    replay: Annotated[Path | None, typer.Option(help="Replay exactly the run recorded in this file.")] = None,
    view: Annotated[
        bool, typer.Option("--view", help="Show the run in a window, or without a display in a browser page.")
    ] = False,
    record: Annotated[
        Path | None, typer.Option(help="File (.rrd) in which to record what --view would show.")
    ] = None,
    web: Annotated[
        bool, typer.Option("--web", help="Show the run in a browser page, as --view does without a display.")
    ] = False,
    view_port: Annotated[int | None, typer.Option(min=1, max=65534, help=VIEW_PORT)] = None,
    view_address: Annotated[str | None, typer.Option(metavar="IP", help=VIEW_ADDRESS)] = None,
    save_atlas: Annotated[
        Path | None, typer.Option(help="Save all maps in this file at the end, Ctrl-C included.")
    ] = None,
    load_atlas: Annotated[Path | None, typer.Option(help="Continue in the maps of this atlas file.")] = None,
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
            help="Seconds between saves of the atlas during the run (--save-atlas, or atlas.vsg in --out).",
        ),
    ] = None,
    frame_timeout: Annotated[
        float,
        typer.Option(
            metavar="SECONDS",
            min=0.1,
            help="Seconds after which a frame with unreadable images is skipped (a stalled network disk).",
        ),
    ] = 10.0,
    overwrite: Annotated[
        bool,
        typer.Option(
            "--overwrite", help="Allow --save-atlas to replace an atlas that the run did not start from."
        ),
    ] = False,
    keep: Annotated[
        int,
        typer.Option(
            min=0,
            max=1000,
            help="Number of earlier versions of the atlas to keep: FILE.1 (the newest), FILE.2, ...",
        ),
    ] = 1,
) -> None:
    """Track a camera through a recorded sequence: trajectory, map, scene graph, floor plan."""
    with told():
        from vsgraphs.cli.run import run_sequence
        from vsgraphs.run import RunRequest, Showing
        from vsgraphs.sources import names_plugin

        request = RunRequest(
            source if names_plugin(source) else Path(source),
            out,
            camera=camera,
            mode=mode,
            execution=execution,
            realtime=realtime or None,
            every=every,
            max_frames=max_frames,
            config=config,
            options=list(set_ or []),
            seed=seed,
            segmenter=segmenter,
            markers=markers,
            map_colours=map_colours,
            schedule_out=schedule_out,
            replay=replay,
            exporters=list(export or []),
            showing=Showing(view, record, view_port, web, view_address),
            save_atlas=save_atlas,
            load_atlas=load_atlas,
            localise_only=localise_only,
            autosave_s=autosave,
            frame_timeout_s=frame_timeout,
            overwrite=overwrite,
            keep=keep,
        )
        code = run_sequence(request)
    raise typer.Exit(code)
