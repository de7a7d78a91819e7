// A segmenter's own classes (table, picture, person), beside the roles of surfaces. A class is numbered by its name, so that two
// maps, or two sessions, mean the same by a number without agreeing on a list first.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"

namespace vsgraphs {

struct ClassId {
  std::uint32_t hash = 0;  // 0: none
  bool none() const { return hash == 0; }
  auto operator<=>(const ClassId&) const = default;
};
template <FieldsOf<ClassId> T>
void visit_fields(T& v, auto& field) {
  field(v.hash);
}

// ADE20K's own list has names of 100 bytes.
inline constexpr std::size_t longest_class_name = 128;
inline constexpr std::size_t most_class_names = 65535;  // an image tells no more apart

// Whether it can be a class's name: UTF-8 of 1 to longest_class_name bytes, without control characters.
bool is_class_name(std::string_view name);
// FNV-1a (Fowler, Noll, Vo, 1991) of the name's bytes; never none. Two names of one number are told where names come in
// (core/system/run/segmentation.h, core/map/map_checks.h).
ClassId class_id(std::string_view name);

using ClassNames = std::map<ClassId, std::string>;

// Sum of confidences with which a class was named.
struct ClassVote {
  ClassId id;
  float weight = 0;
  bool operator==(const ClassVote&) const = default;
};
template <FieldsOf<ClassVote> T>
void visit_fields(T& v, auto& field) {
  auto& [id, weight] = v;
  field(id, weight);
}

// Ascending by id, each class once.
using ClassVotes = std::vector<ClassVote>;

// Adds `share` times the votes. A negative share takes them back: a class that then has less than a thousandth of a keyframe's vote
// left, which may be rounding, is gone.
void add_votes(ClassVotes& sum, const ClassVotes& votes, float share);
// Whether they are in order, and each weight is a number that a map can hold.
bool are_sane(const ClassVotes& votes);
// Whether each of the classes has a name.
bool are_named(const ClassVotes& votes, const ClassNames& names);

}  // namespace vsgraphs
