#include "core/base/text.h"

#include <cstdint>

namespace vsgraphs {

namespace {

struct Lead {
  int to_come = -1;  // bytes that go on; -1: no character begins so
  std::uint32_t bits = 0, least = 0;
};

Lead lead_of(unsigned char byte) {
  if (byte < 0x80) return {0, byte, 0};
  if (byte >= 0xc0 && byte < 0xe0) return {1, byte & 0x1fU, 0x80};
  if (byte >= 0xe0 && byte < 0xf0) return {2, byte & 0x0fU, 0x800};
  if (byte >= 0xf0 && byte < 0xf8) return {3, byte & 0x07U, 0x10000};
  return {};
}

}  // namespace

bool is_text(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const Lead lead = lead_of(static_cast<unsigned char>(bytes[i++]));
    std::uint32_t character = lead.bits;
    if (lead.to_come < 0) return false;
    for (int k = 0; k < lead.to_come; ++k, ++i) {
      const auto byte = i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U;
      if ((byte & 0xc0U) != 0x80) return false;
      character = character << 6 | (byte & 0x3fU);
    }
    const bool half_a_pair = character >= 0xd800 && character < 0xe000;
    if (character < lead.least || half_a_pair || character > 0x10ffff) return false;
  }
  return true;
}

}  // namespace vsgraphs
