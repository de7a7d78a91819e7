#include "core/map/class_votes.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/geometry/bounds.h"

namespace vsgraphs {

bool is_class_name(std::string_view name) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  return !name.empty() && name.size() <= longest_class_name && is_text(name) &&
         std::none_of(name.begin(), name.end(), is_control);
}

ClassId class_id(std::string_view name) {
  std::uint32_t hash = 0x811c9dc5;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193U;
  return {hash == 0 ? 1 : hash};
}

void add_votes(ClassVotes& sum, const ClassVotes& votes, float share) {
  constexpr float least = 1e-3F;
  if (votes.empty()) return;
  for (const ClassVote& vote : votes) {
    const auto at = std::lower_bound(sum.begin(), sum.end(), vote.id,
                                     [](const ClassVote& v, ClassId id) { return v.id < id; });
    const bool there = at != sum.end() && at->id == vote.id;
    if (there)
      at->weight += share * vote.weight;
    else if (share > 0)
      sum.insert(at, {vote.id, share * vote.weight});
  }
  if (share < 0) std::erase_if(sum, [](const ClassVote& vote) { return vote.weight < least; });
}

bool are_sane(const ClassVotes& votes) {
  const auto out_of_order = [](const ClassVote& a, const ClassVote& b) { return !(a.id < b.id); };
  return std::all_of(votes.begin(), votes.end(),
                     [](const ClassVote& vote) {
                       return !vote.id.none() && vote.weight >= 0 &&
                              within(static_cast<double>(vote.weight), most_information);
                     }) &&
         std::adjacent_find(votes.begin(), votes.end(), out_of_order) == votes.end();
}

bool are_named(const ClassVotes& votes, const ClassNames& names) {
  return std::all_of(votes.begin(), votes.end(),
                     [&](const ClassVote& vote) { return names.contains(vote.id); });
}

}  // namespace vsgraphs
