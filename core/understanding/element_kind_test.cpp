#include "core/understanding/element_kind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using ::testing::ElementsAre;

// Pieces of shelves to be found, as each test lays them.
std::vector<FoundElement>& pieces() {
  static std::vector<FoundElement> all;
  return all;
}
std::vector<FoundElement> shelves(const ElementSights&) { return pieces(); }

class Elements : public ::testing::Test {
 protected:
  Elements() { pieces().clear(); }
  static FoundElement piece(const Eigen::Vector3d& centre, const Eigen::Vector3d& size_m,
                            std::uint32_t plane) {
    FoundElement element;
    element.centre = centre;
    element.size_m = size_m;
    element.planes = {{plane, 0}};
    return element;
  }
  std::vector<FoundElement> find() {
    const std::array<ElementKind, 1> kinds{{{"shelf", 0.2, false, &shelves}}};
    previous_ = find_elements(kinds, {map_, surfaces_, structure_}, previous_, next_);
    return previous_;
  }

  Map map_;
  SurfaceKeeper surfaces_;
  FoundStructure structure_;
  std::vector<FoundElement> previous_;
  ElementNumber next_ = 0;
};

TEST_F(Elements, PiecesOfOneThingArePutTogether) {
  pieces() = {piece({0, 0, 1}, {1, 0, 2}, 0), piece({3, 0, 1}, {1, 0, 2}, 1),
              piece({1.1, 0, 1}, {1, 0, 2}, 2)};
  pieces()[2].rooms = {4};
  const auto found = find();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, "shelf");
  EXPECT_TRUE(found[0].centre.isApprox(Eigen::Vector3d(0.55, 0, 1)));
  EXPECT_TRUE(found[0].size_m.isApprox(Eigen::Vector3d(2.1, 0, 2)));
  EXPECT_THAT(found[0].planes, ElementsAre(PlaneId{0, 0}, PlaneId{2, 0}));
  EXPECT_THAT(found[0].rooms, ElementsAre(4));
}

TEST_F(Elements, APieceMayJoinTwoThatWereApart) {
  pieces() = {piece({0, 0, 1}, {1, 0, 2}, 0), piece({2.4, 0, 1}, {1, 0, 2}, 1),
              piece({1.2, 0, 1}, {1.2, 0, 2}, 2)};
  EXPECT_EQ(find().size(), 1U);
}

TEST_F(Elements, FacesOfABoxAreOneBox) {
  FoundElement side = piece({0.2, 0.2, 1}, {0.4, 0, 2}, 1);
  side.along = Eigen::Vector3d::UnitY();
  pieces() = {piece({0, 0, 1}, {0.4, 0, 2}, 0), side};
  const auto found = find();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].size_m.isApprox(Eigen::Vector3d(0.4, 0.4, 2)));
  EXPECT_TRUE(found[0].centre.isApprox(Eigen::Vector3d(0, 0.2, 1)));
}

TEST_F(Elements, KeepTheirNumbersAndGiveThemToNoOther) {
  pieces() = {piece({0, 0, 1}, {1, 0, 2}, 0), piece({3, 0, 1}, {1, 0, 2}, 1)};
  find();
  pieces() = {piece({9, 0, 1}, {1, 0, 2}, 2), piece({3.1, 0, 1}, {1.2, 0, 2}, 1)};
  const auto found = find();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].number, 1U);
  EXPECT_NEAR(found[0].centre.x(), 3.1, 1e-9);
  EXPECT_EQ(found[1].number, 2U) << "0 was another one's";
}

}  // namespace
}  // namespace vsgraphs
