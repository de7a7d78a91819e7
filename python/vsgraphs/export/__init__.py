"""What a run leaves behind, file by file. Files appear complete or not at all."""
