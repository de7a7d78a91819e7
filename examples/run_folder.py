"""All that the program does, from a script: `python examples/run_folder.py FOLDER RESULTS`."""

import sys

import vsgraphs


def main(folder: str, results: str) -> None:
    """Tells of keyframes, rooms and loops as they come, then what was found."""
    result = vsgraphs.run(
        folder,
        out=results,
        on_keyframe=lambda event: print(f"{event.timestamp_s:.3f} s: keyframe"),
        on_room=lambda event: print(f"{event.timestamp_s:.3f} s: room of {event.room.area_m2:.0f} m2"),
        on_loop=lambda event: print(f"{event.timestamp_s:.3f} s: a place looks known: {event.verdict}"),
    )
    for line in result.warnings:
        print(f"warning: {line}")
    print(f"{len(result.trajectory)} poses, {result.statuses}")
    for room in result.scene_graph.rooms.values() if result.scene_graph else ():
        print(f"{room.name or room.id}: {room.area_m2:.1f} m2")
    print("files:", *sorted(result.files))


if __name__ == "__main__":
    main(*sys.argv[1:3])
