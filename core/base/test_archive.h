// An archive as the bytes its file would hold. For tests.
#pragma once

#include <span>
#include <vector>

#include "core/base/archive.h"

namespace vsgraphs::test {

inline Bytes joined(const std::vector<std::span<const std::byte>>& parts) {
  Bytes all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace vsgraphs::test
