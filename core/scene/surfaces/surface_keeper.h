// Keeps what is known of the mapped planes up to the map's edits (KnownSurface): a follower. Cost of an edit: what it touches,
// whatever was seen elsewhere before.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "core/geometry/camera.h"
#include "core/map/follower.h"
#include "core/scene/surfaces/known_surface.h"

namespace vsgraphs {

class SurfaceKeeper : public Follower {
 public:
  explicit SurfaceKeeper(const DepthNoise& noise = {}) : noise_(noise) {}

  // nullptr: no plane, or one that nobody has seen a patch of.
  const KnownSurface* find(PlaneId id) const;
  const StretchPoses& stretches() const { return stretches_; }
  // Planes a keyframe has a patch on.
  std::set<PlaneId> seen_by(KeyframeId keyframe) const;
  // Planes of which something became known since they were interpreted last: by the edit behind the one that set a keyframe's
  // patches.
  const std::set<PlaneId>& changed() const { return changed_; }
  // Planes that a loop or a joined map has moved against others since then.
  const std::set<PlaneId>& moved() const { return moved_; }

  const char* name() const override { return "surfaces"; }
  const char* serves() const override { return "planes"; }
  void follow(const Map& before, const MapEdit& edit, const Map& after, const Follower* absorbed) override;
  void gather(const Map& map) override;
  bool adopt(const Follower& known) override;
  std::shared_ptr<Follower> copy() const override { return std::make_shared<SurfaceKeeper>(*this); }
  void save(ArchiveWriter& archive, const std::string& section) const override;
  void load(const ArchiveReader& archive, const std::string& section) override;
  Wrong wrong_with(const Map& map) const override;

 private:
  struct Sight {
    PlaneId plane;
    std::uint16_t patch = 0;
    bool operator==(const Sight&) const = default;
    template <FieldsOf<Sight> T>
    friend void visit_fields(T& v, auto& field) {
      field(v.plane, v.patch);
    }
  };
  // What a keyframe has been counted for, and as seen from where.
  struct Told {
    Se3 stretch_from_camera;
    std::shared_ptr<const KeyframeSurfaces> patches;
    std::vector<Sight> sights;
    bool rays = false;  // they have been counted for the planes there were
    template <FieldsOf<Told> T>
    friend void visit_fields(T& v, auto& field) {
      field(v.stretch_from_camera, v.patches, v.sights, v.rays);
    }
  };
  class Following;

  void open_stretch(const Map& map, KeyframeId id);
  void tell(const Map& map, PlaneId plane, const PlaneObservation& observation);
  void take_back(const Map& map, PlaneId plane, const PlaneObservation& observation);
  void take_back_patches(const Map& map, KeyframeId keyframe);
  void let_go(const Map& map, KeyframeId keyframe);
  void merge(const Map& after, PlaneId gone, PlaneId into);
  void see_as_one(KnownSurface& known, Told& told, KeyframeId stretch, PlaneId gone, PlaneId into);
  void forget(const Map& map, PlaneId plane);
  void absorb(const Map& map, const SurfaceKeeper& other);
  void follow_keyframes(const Map& map);
  void tell_rays(const Map& map, KeyframeId keyframe);
  void settle(const Map& map);
  void settle_touched(const Map& map);
  void find_largest_patch(const Map& map, PlaneId plane);
  SurfaceVotes votes_of(const Told& told, PlaneId plane) const;
  static bool sees(const Told& told, PlaneId plane);
  template <typename Change>
  void change_sights(const Map& map, PlaneId plane, KeyframeId keyframe, const Change& change);

  DepthNoise noise_;
  std::map<PlaneId, KnownSurface> known_;
  std::map<KeyframeId, Told> told_;
  StretchPoses stretches_;
  std::optional<Eigen::Vector3d> up_;  // with which the planes' axes were laid; rays are counted from then on
  std::set<PlaneId> changed_, moved_;
  std::set<KeyframeId>
      shifted_;  // stretches that stand elsewhere, or in which a keyframe does, since the edit before
  std::set<PlaneId> touched_;  // by the edit that is followed
  bool to_interpret_ = false;  // the next edit is what was made of the two
};

}  // namespace vsgraphs
