// Recognition of structural elements: from free space and classified surfaces to rooms, doors, floors and places.
// vS-Graphs, section "Structural Element Recognition".
#pragma once

#include <span>
#include <vector>

#include "core/map/structure.h"
#include "core/scene/rooms/clusters.h"
#include "core/scene/rooms/doors.h"
#include "core/scene/rooms/floors.h"
#include "core/scene/rooms/level_map.h"
#include "core/scene/rooms/openings.h"
#include "core/scene/rooms/places.h"
#include "core/scene/rooms/room_outline.h"
#include "core/scene/rooms/rooms.h"
#include "core/scene/rooms/surfaces.h"
#include "core/scene/space/space_view.h"

namespace vsgraphs {

struct StructureOptions {
  LevelOptions level;
  OpeningOptions opening;
  ClusterOptions cluster;
  OutlineOptions outline;
  RoomOptions room;
  DoorOptions door;
  FloorOptions floor;
  PlaceOptions place;
};

// One pass over everything known, all in one levelled frame. `previous`: what the last pass found (its rooms keep their
// numbers). Nothing is found before there is a ground. Pure: the same input gives the same output.
FoundStructure recognise_structure(const SpaceView& space, const SceneFaces& faces,
                                   const FoundStructure& previous, const StructureOptions& options);

}  // namespace vsgraphs
