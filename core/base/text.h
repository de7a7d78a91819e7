// Whether bytes are a text.
#pragma once

#include <string_view>

namespace vsgraphs {

// UTF-8 (RFC 3629): no overlong forms, no halves of surrogate pairs, nothing beyond U+10FFFF. What Python takes for a str.
bool is_text(std::string_view bytes);

}  // namespace vsgraphs
