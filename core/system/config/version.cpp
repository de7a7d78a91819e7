#include "core/system/config/version.h"

namespace vsgraphs {

const char* version() { return VSGRAPHS_VERSION; }

const char* processor_level() { return VSGRAPHS_LEVEL; }

}  // namespace vsgraphs
