"""`python -m vsgraphs`."""

from vsgraphs.cli import main

main()
