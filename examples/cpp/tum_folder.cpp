#include "tum_folder.h"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

namespace {

namespace fs = std::filesystem;

constexpr double max_gap_s = 0.02;  // between a colour image and its depth

std::ifstream open(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return file;
}

std::vector<std::vector<std::string>> rows_of(const fs::path& path, std::size_t columns) {
  std::ifstream file = open(path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::vector<std::string> row;
    for (std::string word; words >> word;) row.push_back(word);
    if (row.empty()) continue;
    if (row.size() != columns) throw std::runtime_error(path.string() + ": not understood: " + line);
    rows.push_back(row);
  }
  return rows;
}

double number(const std::string& word, const fs::path& where) {
  try {
    return std::stod(word);
  } catch (const std::exception&) {
    throw std::runtime_error(where.string() + ": not a number: " + word);
  }
}

vsgraphs::Camera read_camera(const fs::path& path) {
  vsgraphs::Camera camera;
  double width = 0, height = 0;
  const std::map<std::string, double*> fields{{"width", &width},
                                              {"height", &height},
                                              {"fx", &camera.fx},
                                              {"fy", &camera.fy},
                                              {"cx", &camera.cx},
                                              {"cy", &camera.cy},
                                              {"fps", &camera.fps},
                                              {"depth_scale", &camera.depth_scale},
                                              {"depth_min", &camera.depth_min_m},
                                              {"depth_max", &camera.depth_max_m},
                                              {"k1", &camera.distortion[0]},
                                              {"k2", &camera.distortion[1]},
                                              {"p1", &camera.distortion[2]},
                                              {"p2", &camera.distortion[3]},
                                              {"k3", &camera.distortion[4]}};
  std::ifstream file = open(path);
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string key = line.substr(0, colon);
    if (key == "distortion") {
      throw std::runtime_error(path.string() + ": this example reads the lens as k1: k2: p1: p2: k3:");
    }
    const auto field = fields.find(key);
    if (field != fields.end()) *field->second = number(line.substr(colon + 1), path);
  }
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
  return camera;  // Slam checks it
}

std::vector<FramePaths> read_pairs(const fs::path& folder) {
  std::vector<FramePaths> frames;
  if (const fs::path list = folder / "associations.txt"; fs::exists(list)) {
    for (const auto& row : rows_of(list, 4))
      frames.push_back({number(row[0], list), folder / row[1], folder / row[3]});
    return frames;
  }
  const auto depths = rows_of(folder / "depth.txt", 2);
  std::size_t next = 0;
  for (const auto& row : rows_of(folder / "rgb.txt", 2)) {
    const double stamp = number(row[0], folder / "rgb.txt");
    const auto gap = [&](std::size_t i) {
      return std::abs(number(depths[i][0], folder / "depth.txt") - stamp);
    };
    while (next + 1 < depths.size() && gap(next + 1) <= gap(next)) ++next;
    if (next < depths.size() && gap(next) <= max_gap_s)
      frames.push_back({stamp, folder / row[1], folder / depths[next][1]});
  }
  return frames;
}

}  // namespace

TumFolder open_tum_folder(const fs::path& folder) {
  TumFolder opened{read_camera(folder / "camera.yaml"), read_pairs(folder)};
  if (opened.frames.empty()) throw std::runtime_error(folder.string() + " has no frames");
  return opened;
}
