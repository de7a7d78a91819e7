// Random numbers that repeat: a generator is derived from (run seed, stage, id), never from time or address.
// Algorithms: SplitMix64 (Steele, Lea, Flood 2014) for seeding, xoshiro256** (Blackman, Vigna 2018).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace vsgraphs {

class Rng {
 public:
  // `stage` names who draws ("tracker"), `id` what for (a keyframe or frame number).
  Rng(std::uint64_t seed, std::string_view stage, std::uint64_t id) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a over the stage's name
    for (char c : stage) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    std::uint64_t x = seed ^ (hash + 0x9e3779b97f4a7c15ULL * (id + 1));
    for (auto& word : state_) word = split_mix(x);
  }

  std::uint64_t next() {
    const std::uint64_t result = rotate(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  // Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // Uniform in 0..bound-1; bound > 0. The bias of the multiply method is below 2^-32 for bounds in use.
  std::uint32_t index(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((next() >> 32) * static_cast<std::uint64_t>(bound)) >> 32);
  }
  // Standard normal (Box-Muller, one of the pair).
  double normal() {
    const double u = 1.0 - uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  static std::uint64_t rotate(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }
  static std::uint64_t split_mix(std::uint64_t& x) {
    std::uint64_t z = (x += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace vsgraphs
