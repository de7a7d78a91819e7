// Checks that throw: at the boundaries (`InputError`: the caller's data or call is wrong; the message names
// the cure) and for invariants (`InvariantError`: a defect of ours). Nothing in the core calls exit or abort.
#pragma once

#include <stdexcept>
#include <string>

namespace vsgraphs {

// What the user gave cannot be used: a file, an option, an array of the wrong shape.
class InputError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// A promise the code makes to itself is broken.
class InvariantError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

// A run cannot go on as it was asked to: a replay departs from its schedule. What was done so far stays valid.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void require_input(bool ok, const std::string& message) {
  if (!ok) throw InputError(message);
}

[[noreturn]] inline void invariant_failed(const char* what, const char* file, int line) {
  throw InvariantError(std::string(file) + ":" + std::to_string(line) + ": " + what);
}

}  // namespace vsgraphs

// A macro because the message needs the expression and the place.
#define VSG_INVARIANT(condition) \
  ((condition) ? void(0) : ::vsgraphs::invariant_failed(#condition, __FILE__, __LINE__))
