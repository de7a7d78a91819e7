#include "core/system/maps/followers.h"

#include "core/scene/space/space_keeper.h"
#include "core/scene/surfaces/surface_keeper.h"
#include "core/vision/place_keeper.h"

namespace vsgraphs {

Followers make_followers(const Config& config, const Camera& camera) {
  std::vector<std::shared_ptr<Follower>> all{std::make_shared<PlaceKeeper>(config.places)};
  if (config.system.builds_scene()) all.push_back(std::make_shared<SurfaceKeeper>(camera.depth_noise));
  if (config.system.builds_structure())
    all.push_back(
        std::make_shared<SpaceKeeper>(config.structure.free_space, config.structure.max_reintegrations));
  return Followers(std::move(all));
}

}  // namespace vsgraphs
