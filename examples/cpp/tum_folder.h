// The layout of the TUM RGB-D benchmark (Sturm et al., IROS 2012): camera.yaml, and associations.txt or rgb.txt and
// depth.txt. Only what an example needs: flat keys in camera.yaml, lists in order of time.
#pragma once

#include <filesystem>
#include <vector>

#include "core/geometry/camera.h"

struct FramePaths {
  double timestamp_s = 0;  // of the colour image
  std::filesystem::path colour, depth;
};

struct TumFolder {
  vsgraphs::Camera camera;
  std::vector<FramePaths> frames;
};

// Throws std::runtime_error that names the file.
TumFolder open_tum_folder(const std::filesystem::path& folder);
