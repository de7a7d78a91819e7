#include "core/matching/messages.h"

namespace vsgraphs {

const char* to_string(TrackStatus status) {
  switch (status) {
    case TrackStatus::waiting:
      return "waiting";
    case TrackStatus::initialised:
      return "initialised";
    case TrackStatus::ok:
      return "ok";
    case TrackStatus::coasting:
      return "coasting";
    case TrackStatus::lost:
      return "lost";
    case TrackStatus::relocalised:
      return "relocalised";
  }
  return "unknown";
}

}  // namespace vsgraphs
