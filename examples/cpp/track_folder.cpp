// Tracks a camera through a folder in the layout of TUM RGB-D and prints the rooms: track_folder FOLDER
#include <cstdio>
#include <exception>

#include "core/system/config/version.h"
#include "core/system/run/slam.h"
#include "png_image.h"
#include "tum_folder.h"

namespace {

void print_rooms(const vsgraphs::FoundStructure& structure) {
  std::printf("%zu rooms\n", structure.rooms.size());
  for (const vsgraphs::FoundRoom& room : structure.rooms)
    std::printf("room %u: %.1f m2, %zu walls, %zu neighbours%s\n", room.number, room.area_m2,
                room.walls.size(), room.neighbours.size(), room.partial ? ", seen in part" : "");
}

void track(const TumFolder& folder) {
  vsgraphs::Config config;
  config.set("system.execution", std::string("serial"));
  vsgraphs::Slam slam(config, folder.camera);
  for (const FramePaths& paths : folder.frames) {
    const auto colour = read_colour(paths.colour);
    const auto depth = read_depth(paths.depth);
    vsgraphs::RgbdFrame frame;
    frame.timestamp_s = paths.timestamp_s;
    frame.colour = colour.view();
    frame.depth.raw = depth.view();
    slam.track(frame);
  }
  slam.finish();
  const auto trajectory = slam.trajectory();  // world_from_camera, metres
  std::printf("%zu of %zu frames tracked\n", trajectory.size(), folder.frames.size());
  if (!trajectory.empty()) {
    const Eigen::Vector3d end = trajectory.back().world_from_camera.translation();
    std::printf("the path ends at %.6f %.6f %.6f\n", end.x(), end.y(), end.z());
  }
  print_rooms(slam.snapshot()->structure());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: track_folder FOLDER\n");
    return 2;
  }
  try {
    std::printf("vsgraphs %s for %s\n", vsgraphs::version(), vsgraphs::processor_level());
    track(open_tum_folder(argv[1]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  return 0;
}
