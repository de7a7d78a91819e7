"""What stands below the options of --help. A blank line ends a paragraph."""

PROGRAM = """First steps, with a simulated recording (or a FOLDER of your own instead of `rooms`):

vsgraphs simulate three_rooms --every 3 --out rooms

vsgraphs run rooms (floorplan.svg and more, in rooms_vsgraphs)

vsgraphs eval rooms_vsgraphs (found against true)

vsgraphs COMMAND --help tells more."""

RUN = """Examples:

vsgraphs run FOLDER (results in ./FOLDER_vsgraphs)

vsgraphs run FOLDER --out results --view (watch the map grow)

vsgraphs run FOLDER --max-frames 300 (the beginning only)

Then: vsgraphs info RESULTS, vsgraphs view RESULTS, vsgraphs eval RESULTS."""

EVAL = """Examples:

vsgraphs eval RESULTS (the truth is in the recording's folder)

vsgraphs eval RESULTS --groundtruth truth.txt --plot error.png"""

VIEW = "Example: vsgraphs view RESULTS"

SIMULATE = "Example: vsgraphs simulate two_rooms --every 3 --out rooms, then vsgraphs run rooms"

INFO = "Examples: vsgraphs info RESULTS; vsgraphs info house.vsg --json"

EXPORT = "Example: vsgraphs export RESULTS floorplan spark-dsg --out elsewhere"

CONFIG = (
    "Examples: vsgraphs config tracker; vsgraphs config explain orb.max_features; "
    "vsgraphs config --yaml > mine.yaml"
)
