// Furniture made of boxes, and plants.
#include "simulate/furniture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/canvas.h"

namespace vsgraphs {
namespace {

using Eigen::Vector3d;

void plain_box(Piece& p) { p.box({-p.w, -p.d, 0}, {p.w, p.d, p.h}, {"cloth", p.seed, p.colour}); }

void rug(Piece& p) { p.box({-p.w, -p.d, 0}, {p.w, p.d, p.h}, {"rug", p.seed, p.colour}, BoxSide::top); }

void parcel(Piece& p) {
  const Material side{"parcel", p.seed, p.colour};
  p.box({-p.w, -p.d, 0}, {p.w, p.d, p.h}, side, all_sides & ~BoxSide::bottom);
}

void bookshelf(Piece& p) {
  const Material wood = {"wood", 7, p.colour}, dark{"wood", 7, {52, 44, 38}};
  const double board = 0.022;
  p.box({-p.w, -p.d, 0}, {-p.w + board, p.d, p.h}, wood);
  p.box({p.w - board, -p.d, 0}, {p.w, p.d, p.h}, wood);
  p.box({-p.w, -p.d, 0}, {p.w, -p.d + 0.01, p.h}, dark);
  const int shelves = std::max(2, static_cast<int>(p.h / 0.36));
  const double pitch = (p.h - board) / shelves;
  Rng rng(p.seed, "bookshelf", 0);
  for (int i = 0; i <= shelves; ++i) {
    const double z = pitch * i;
    p.box({-p.w + board, -p.d, z}, {p.w - board, p.d, z + board}, wood);
    if (i == shelves || i == 0) continue;  // the lowest compartment stays empty
    double x = -p.w + board + rng.uniform(0, 0.05);
    const double end = p.w - board - rng.uniform(0, 0.3) * p.w;
    while (true) {
      const double width = rng.uniform(0.022, 0.055), height = (pitch - board) * rng.uniform(0.6, 0.93);
      const double front = p.d - rng.uniform(0.02, 0.05);
      const Material spine{"spine", rng.index(24), {255, 255, 255}};
      if (x + width > end) break;
      p.box({x, -p.d + 0.03, z + board}, {x + width, front, z + board + height},
            {"lacquer", 7, {196, 188, 170}}, BoxSide::top, std::nullopt);
      p.box({x, -p.d + 0.03, z + board}, {x + width, front, z + board + height}, spine,
            BoxSide::front | BoxSide::left | BoxSide::right);
      x += width + (rng.uniform() < 0.1 ? rng.uniform(0.03, 0.1) : 0.0);
    }
  }
}

void cupboard(Piece& p, const char* front) {
  const double foot = std::min(0.05, 0.2 * p.h);
  p.box({-p.w + 0.02, -p.d, 0}, {p.w - 0.02, p.d - 0.04, foot}, {"lacquer", 7, {40, 38, 38}});
  p.box({-p.w, -p.d, foot}, {p.w, p.d, p.h}, p.plain("wood"), all_sides, Material{front, p.seed, p.colour});
}

void table(Piece& p) {
  const double leg = 0.05, top = 0.035;
  p.box({-p.w, -p.d, p.h - top}, {p.w, p.d, p.h}, p.plain("wood"));
  for (const double x : {-p.w, p.w - leg})
    for (const double y : {-p.d, p.d - leg}) p.box({x, y, 0}, {x + leg, y + leg, p.h - top}, p.plain());
}

void chair(Piece& p) {
  const double leg = 0.04, seat = std::min(0.45, 0.55 * p.h);
  p.box({-p.w, -p.d, seat - 0.04}, {p.w, p.d, seat}, {"cloth", p.seed, p.colour});
  p.box({-p.w, -p.d, seat}, {p.w, -p.d + 0.04, p.h}, {"cloth", p.seed, p.colour});
  for (const double x : {-p.w, p.w - leg})
    for (const double y : {-p.d, p.d - leg})
      p.box({x, y, 0}, {x + leg, y + leg, seat - 0.04}, {"lacquer", 7, {70, 70, 74}});
}

void sofa(Piece& p) {
  const Material cloth{"cloth", p.seed, p.colour};
  const double arm = 0.16, seat = 0.55 * p.h, back = std::min(0.22, 0.6 * p.d);
  p.box({-p.w, -p.d, 0}, {p.w, -p.d + back, p.h}, cloth);
  p.box({-p.w, -p.d, 0}, {-p.w + arm, p.d, 0.75 * p.h}, cloth);
  p.box({p.w - arm, -p.d, 0}, {p.w, p.d, 0.75 * p.h}, cloth);
  p.box({-p.w + arm, -p.d + back, 0}, {-0.01, p.d - 0.02, seat}, cloth);
  p.box({0.01, -p.d + back, 0}, {p.w - arm, p.d - 0.02, seat}, cloth);
  p.box({-0.5 * p.w, -p.d + back, seat}, {-0.2 * p.w, -p.d + back + 0.14, seat + 0.35 * p.h},
        {"rug", p.seed + 1, {150, 96, 70}});
}

void bed(Piece& p) {
  p.box({-p.w, -p.d, 0}, {p.w, p.d, 0.55 * p.h}, p.plain("wood"));
  p.box({-p.w, -p.d, 0.55 * p.h}, {p.w, p.d, p.h}, {"cloth", p.seed, {198, 196, 190}});
  p.box({-p.w, -p.d, 0}, {p.w, -p.d + 0.05, 1.7 * p.h}, p.plain("wood"));
  p.box({-0.7 * p.w, -p.d + 0.1, p.h}, {0.7 * p.w, -p.d + 0.45, p.h + 0.1}, {"rug", p.seed, p.colour});
}

void pillar(Piece& p) {
  p.box({-p.w, -p.d, 0}, {p.w, p.d, p.h}, {"paint", p.seed, p.colour}, all_sides & ~BoxSide::bottom);
}

void leaf(Piece& p, Rng& rng, const Vector3d& root, double length) {
  const double turn = rng.uniform(0, 2 * std::numbers::pi), lean = rng.uniform(0.1, 1.15);
  const Vector3d t(std::cos(turn) * std::sin(lean), std::sin(turn) * std::sin(lean), std::cos(lean));
  const Vector3d s = t.cross(Vector3d(std::cos(turn), std::sin(turn), -0.3)).normalized();
  const double w = 0.22 * length;
  const Polygon2 outline{
      {0.5 * w, 0},      {0.85 * w, 0.25 * length}, {w, 0.5 * length}, {0.7 * w, 0.8 * length},
      {0.5 * w, length}, {0.25 * w, 0.8 * length},  {0, 0.5 * length}, {0.15 * w, 0.25 * length}};
  const Material green{"leaf", rng.index(3), {30, static_cast<std::uint8_t>(75 + rng.index(35)), 38}};
  const Vector3d corner = root - 0.5 * w * s;
  const Vector3d far_corner = root + 0.5 * w * s;
  p.builder.add_face(p.tag, p.stand.at(corner), p.stand.direction(s), p.stand.direction(t), {w, length},
                     {outline}, green);
  p.builder.add_face(p.tag, p.stand.at(far_corner), p.stand.direction(-s), p.stand.direction(t), {w, length},
                     {outline}, green);
}

void plant(Piece& p) {
  const double pot = 0.36 * p.h;
  const Material clay =
      p.seed % 2 ? Material{"brick", p.seed, {140, 70, 55}} : Material{"concrete", p.seed, {138, 138, 134}};
  p.box({-p.w, -p.d, 0}, {p.w, p.d, pot}, clay);
  Rng rng(p.seed, "plant", 0);
  for (int i = 0; i < 30; ++i)
    leaf(p, rng, {rng.uniform(-0.2, 0.2) * p.w, rng.uniform(-0.2, 0.2) * p.d, pot},
         (p.h - pot) * rng.uniform(0.6, 1.0));
}

void floor_lamp(Piece& p) {
  const Material metal{"lacquer", 7, {96, 96, 100}};
  const double shade = 0.18 * p.h;
  p.box({-0.12, -0.12, 0}, {0.12, 0.12, 0.03}, {"lacquer", 7, {40, 40, 42}});
  p.box({-0.015, -0.015, 0.03}, {0.015, 0.015, p.h - shade}, metal);
  const std::size_t begin = p.builder.scene().faces.size();
  p.box({-p.w, -p.d, p.h - shade}, {p.w, p.d, p.h}, {"curtain", 9, {226, 220, 204}});
  for (std::size_t i = begin; i < p.builder.scene().faces.size(); ++i)
    p.builder.scene().faces[i].emission = 1.05f;
  p.builder.scene().lights.push_back({p.stand.at({0, 0, p.h}), {0, 0, 1}, 0.25, p.tag.room});
}

void monitor(Piece& p, const Material& front) {
  const Material black{"lacquer", 7, {34, 34, 36}};
  p.box({-0.12, -p.d, 0}, {0.12, p.d, 0.015}, black);
  p.box({-0.02, -0.02, 0.015}, {0.02, 0.02, 0.3 * p.h}, black);
  p.box({-p.w, -0.02, 0.25 * p.h}, {p.w, 0.02, p.h}, black, all_sides, front);
}

void photo(Piece& p) {
  p.box({-p.w, -p.d, 0}, {p.w, p.d, p.h}, {"lacquer", 7, {60, 48, 40}}, all_sides,
        Material{"picture", p.seed, {255, 255, 255}});
}

void books(Piece& p) {
  Rng rng(p.seed, "books", 0);
  const int count = std::max(1, static_cast<int>(p.h / 0.035));
  for (int i = 0; i < count; ++i) {
    const double shift = rng.uniform(-0.02, 0.02), z = p.h * i / count;
    p.box({-0.9 * p.w + shift, -0.9 * p.d + shift, z},
          {0.9 * p.w + shift, 0.9 * p.d + shift, z + p.h / count},
          {"cloth", rng.index(6), random_hue(rng, 0.4, 0.6)});
  }
}

constexpr double small = 0.12;  // shading of things that lie about on tables

constexpr FurnitureKind table_of_kinds[] = {
    {"box", SceneClass::misc, {120, 96, 92}, plain_box},
    {"parcel", SceneClass::misc, {156, 112, 66}, parcel},
    {"bookshelf", SceneClass::cabinet, {168, 140, 92}, bookshelf},
    {"sideboard", SceneClass::cabinet, {188, 180, 166}, [](Piece& p) { cupboard(p, "cupboard"); }},
    {"drawers", SceneClass::cabinet, {188, 180, 166}, [](Piece& p) { cupboard(p, "drawers"); }},
    {"wardrobe", SceneClass::cabinet, {150, 118, 84}, [](Piece& p) { cupboard(p, "cupboard"); }},
    {"table", SceneClass::table, {164, 128, 88}, table},
    {"chair", SceneClass::chair, {70, 88, 120}, chair},
    {"sofa", SceneClass::sofa, {96, 108, 104}, sofa},
    {"bed", SceneClass::bed, {140, 106, 74}, bed},
    {"plant", SceneClass::plant, {60, 110, 60}, plant},
    {"floor_lamp", SceneClass::lamp, {226, 220, 204}, floor_lamp},
    {"screen",
     SceneClass::screen,
     {34, 34, 36},
     [](Piece& p) { monitor(p, {"screen", p.seed, {255, 255, 255}}); }},
    {"dark_screen", SceneClass::screen, {16, 16, 18}, [](Piece& p) { monitor(p, p.plain()); }},
    {"photo", SceneClass::picture, {60, 48, 40}, photo},
    {"books", SceneClass::misc, {120, 60, 60}, books},
    {"keyboard", SceneClass::misc, {206, 202, 190}, keyboard, small},
    {"papers", SceneClass::misc, {226, 225, 220}, papers, small},
    {"magazine", SceneClass::misc, {255, 255, 255}, magazine, small},
    {"mug", SceneClass::misc, {224, 222, 216}, mug, small},
    {"pens", SceneClass::misc, {60, 66, 74}, pens, small},
    {"booklet", SceneClass::misc, {255, 255, 255}, booklet, small},
    {"carton", SceneClass::misc, {208, 196, 172}, carton, small},
    {"pillar", SceneClass::pillar, {198, 200, 194}, pillar},
    {"rug", SceneClass::rug, {72, 112, 72}, rug},
};

}  // namespace

std::span<const FurnitureKind> furniture_table() { return table_of_kinds; }

std::vector<std::string> furniture_kinds() {
  std::vector<std::string> names;
  for (const FurnitureKind& kind : table_of_kinds) names.emplace_back(kind.name);
  return names;
}

}  // namespace vsgraphs
