// Rooms keep their numbers from one pass to the next.
#pragma once

#include <span>

#include "core/map/structure.h"

namespace vsgraphs {

// Gives each room the number of the previous room whose area it overlaps and whose walls it shares the most, each number
// to one room; rooms that were not there before get numbers from `next_number` on, which is moved on.
void number_rooms(std::span<const FoundRoom> previous, std::span<FoundRoom> rooms, RoomNumber& next_number);

}  // namespace vsgraphs
