// How a value declares what it is made of: one function beside the struct names every field, and whatever goes through
// values (archives, in both directions, and hashes) derives from it, so that writing and reading cannot disagree.
//
//   struct Observation { KeyframeId keyframe; std::uint16_t feature; };
//   template <FieldsOf<Observation> T>  // T: Observation or const Observation
//   void visit_fields(T& v, auto& field) {
//     auto& [keyframe, feature] = v;    // does not compile once a field is added and not named here
//     field(keyframe, feature);
//   }
//
// A field that came later than the first format of its file is declared apart, with the version it came in, and stays as it
// is where an older file is read: `field.since(3, stretch);`
//
// Fields may be numbers, enums, Eigen matrices of fixed size, strings, standard containers, optionals, shared constants
// (std::shared_ptr<const T>) and values that declare their fields in turn.
#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace vsgraphs {

template <typename T, typename Value>
concept FieldsOf = std::same_as<std::remove_const_t<T>, Value>;

// How many values an enum has, from 0 on; specialised beside the enum. An enum without cannot be a field.
template <typename Enum>
inline constexpr std::size_t enum_size = 0;

// Names a type whose values are shared and constant, as an archive stores them once; specialised beside the type.
template <typename Value>
inline constexpr const char* shared_name = nullptr;

}  // namespace vsgraphs
