"""`vsgraphs simulate` on the command line: its options, and what becomes of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vsgraphs.cli import completion
from vsgraphs.cli.failures import told


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
            help="Instead of PLAN, drawn by --seed: desk, kitchen, or flat or office with all that is hard.",
            autocompletion=completion.chosen_from("flat", "office", "desk", "kitchen"),
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
