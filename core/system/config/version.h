// What this library is: its version, and the processors it is compiled for.
#pragma once

namespace vsgraphs {

// As CMakeLists.txt names it ("0.1.0"), the one place it is written down.
const char* version();

// The oldest processor the code runs on: "x86-64-v3", ... ("generic" where it is not x86). Results of different levels
// differ in their last bits: sums of vectors are taken in another order.
const char* processor_level();

}  // namespace vsgraphs
