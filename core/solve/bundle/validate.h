// Checks of a problem before it is solved.
#pragma once

#include "core/solve/bundle_adjustment.h"

namespace vsgraphs {

// Throws InputError naming the first entry that cannot be used. Linear in the problem's size.
void validate(const BundleProblem& problem, const BundleOptions& options);

}  // namespace vsgraphs
