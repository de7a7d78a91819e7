#include "core/base/archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/rng.h"
#include "core/base/test_archive.h"

namespace vsgraphs {

// A value with one field of every sort.
enum class Colour : std::uint8_t { red, green };
template <>
inline constexpr std::size_t enum_size<Colour> = 2;

struct Leaf {
  std::vector<std::uint16_t> numbers;
  bool operator==(const Leaf&) const = default;
};
template <FieldsOf<Leaf> T>
void visit_fields(T& v, auto& field) {
  auto& [numbers] = v;
  field(numbers);
}
template <>
inline constexpr const char* shared_name<Leaf> = "leaves";

// As a later version of the program has it.
struct LaterLeaf {
  Leaf leaf;
  int veins = 3;
};
template <FieldsOf<LaterLeaf> T>
void visit_fields(T& v, auto& field) {
  auto& [leaf, veins] = v;
  field(leaf);
  field.since(2, veins);
}

struct Tree {
  bool tall = false;
  double height = 0;
  Colour colour = Colour::red;
  std::string name;
  std::array<int, 3> triple{};
  std::optional<float> age;
  std::map<int, std::string> words;
  std::deque<Leaf> fallen;
  std::vector<std::shared_ptr<const Leaf>> leaves;
};
template <FieldsOf<Tree> T>
void visit_fields(T& v, auto& field) {
  auto& [tall, height, colour, name, triple, age, words, fallen, leaves] = v;
  field(tall, height, colour, name, triple, age, words, fallen, leaves);
}

namespace {

constexpr ArchiveKind kind{"TESTTREE", 3, "tree"};

Tree some_tree() {
  const auto shared = std::make_shared<const Leaf>(Leaf{{7, 8, 9}});
  Tree tree;
  tree.tall = true;
  tree.height = 0.1;
  tree.colour = Colour::green;
  tree.name = "ash";
  tree.triple = {1, -2, 3};
  tree.age = 4.5F;
  tree.words = {{-1, "a"}, {2, ""}};
  tree.fallen = {{{1}}, {}};
  tree.leaves = {shared, nullptr, std::make_shared<const Leaf>(Leaf{{1}}), shared};
  return tree;
}

Bytes bytes_of(const Tree& tree, const ArchiveKind& as = kind) {
  ArchiveWriter archive(as);
  archive.add("tree", tree);
  archive.add("number", 42);
  return test::joined(archive.finish());
}

Tree tree_of(std::span<const std::byte> bytes) {
  ArchiveReader archive("FILE", bytes, kind);
  archive.load_shared<Leaf>();
  Tree tree;
  int number = 0;
  archive.read("tree", tree);
  archive.read("number", number);
  EXPECT_EQ(number, 42);
  return tree;
}

std::string error_of(std::span<const std::byte> bytes) {
  try {
    tree_of(bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Archive, GivesBackWhatWasWritten) {
  const Tree tree = some_tree();
  const Tree back = tree_of(bytes_of(tree));
  EXPECT_TRUE(back.tall);
  EXPECT_EQ(back.height, tree.height);
  EXPECT_EQ(back.colour, tree.colour);
  EXPECT_EQ(back.name, tree.name);
  EXPECT_EQ(back.triple, tree.triple);
  EXPECT_EQ(back.age, tree.age);
  EXPECT_EQ(back.words, tree.words);
  EXPECT_EQ(back.fallen, tree.fallen);
  EXPECT_EQ(bytes_of(back), bytes_of(tree));
}

TEST(Archive, KeepsSharedConstantsShared) {
  const Tree back = tree_of(bytes_of(some_tree()));
  ASSERT_EQ(back.leaves.size(), 4U);
  EXPECT_EQ(*back.leaves[0], (Leaf{{7, 8, 9}}));
  EXPECT_EQ(back.leaves[0], back.leaves[3]);  // one object
  EXPECT_EQ(back.leaves[1], nullptr);
  EXPECT_EQ(*back.leaves[2], (Leaf{{1}}));
}

TEST(Archive, EveryFlippedBitIsNoticed) {
  const Bytes whole = bytes_of(some_tree());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes flipped = whole;
      flipped[at] ^= static_cast<std::byte>(1 << bit);
      EXPECT_THAT(error_of(flipped), testing::StartsWith("FILE: ")) << "byte " << at;
    }
  }
}

TEST(Archive, EveryLengthButItsOwnIsNoticed) {
  Bytes bytes = bytes_of(some_tree());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THAT(error_of(std::span(bytes).first(length)), testing::StartsWith("FILE: ")) << length;
  }
  bytes.push_back(std::byte{0});
  EXPECT_THAT(error_of(bytes), testing::HasSubstr("something follows"));
}

// As a file might be that somebody made on purpose: the checksums are right, the content is not.
TEST(Archive, SectionsThatLieAreErrorsOrValues) {
  Rng rng(5, "archive_test", 0);
  const Tree tree = some_tree();
  const Bytes whole = bytes_of(tree);
  const ArchiveReader original("FILE", whole, kind);
  int errors = 0;
  for (int round = 0; round < 3000; ++round) {
    ArchiveWriter forged(kind);
    for (const std::string& name : original.names()) {
      const auto section = original.section(name);
      Bytes bytes(section.begin(), section.end());
      if (name != "number")
        bytes[rng.index(static_cast<std::uint32_t>(bytes.size()))] = static_cast<std::byte>(rng.next());
      if (rng.index(10) == 0 && name == "tree")
        bytes.resize(rng.index(static_cast<std::uint32_t>(bytes.size())));
      forged.add_bytes(name, std::move(bytes));
    }
    const Bytes bytes = test::joined(forged.finish());
    errors += error_of(bytes).empty() ? 0 : 1;
  }
  EXPECT_GT(errors, 500);
}

TEST(Archive, AHugeLengthIsNoticedBeforeAnythingIsAllocated) {
  ArchiveWriter archive(kind);
  archive.add("numbers", std::uint64_t{1} << 60);
  const Bytes bytes = test::joined(archive.finish());
  const ArchiveReader reader("FILE", bytes, kind);
  std::vector<std::uint64_t> numbers;
  std::string text;
  EXPECT_THROW(reader.read("numbers", numbers), InputError);
  EXPECT_THROW(reader.read("numbers", text), InputError);
}

TEST(Archive, ANewerVersionIsSaidAndAnOlderOneTold) {
  ArchiveKind newer = kind;
  newer.version = 4;
  EXPECT_EQ(error_of(bytes_of(some_tree(), newer)),
            "FILE: was saved in version 4 of the tree format, and this vsgraphs reads up to version 3; "
            "update vsgraphs");
  ArchiveKind older = kind;
  older.version = 2;
  const Bytes bytes = bytes_of(some_tree(), older);
  EXPECT_EQ(ArchiveReader("FILE", bytes, kind).version(), 2U);
}

TEST(Archive, SaysWhenAFileIsSomethingElse) {
  const std::string text = "P6 640 480 255 and many pixels";
  EXPECT_EQ(error_of(std::as_bytes(std::span(text))),
            "FILE: is no vsgraphs tree; give a file that vsgraphs saved");
  EXPECT_THAT(error_of({}), testing::HasSubstr("is damaged (it ends too early)"));
}

TEST(Archive, SaysWhichSectionIsMissing) {
  ArchiveWriter archive(kind);
  archive.add("number", 42);
  const Bytes bytes = test::joined(archive.finish());
  EXPECT_THAT(error_of(bytes), testing::HasSubstr("section 'tree' is missing"));
}

TEST(Archive, AFieldThatCameLaterStaysAsItIsWhereAnOlderFileIsRead) {
  constexpr ArchiveKind old_kind{"TESTFILE", 1, "test"}, new_kind{"TESTFILE", 2, "test"};
  ArchiveWriter old_writer(old_kind), new_writer(new_kind);
  old_writer.add("oak", Leaf{{4}}, Leaf{{5}});
  new_writer.add("oak", LaterLeaf{{{4}}, 7}, LaterLeaf{{{5}}, 8});
  const Bytes old_file = test::joined(old_writer.finish()), new_file = test::joined(new_writer.finish());
  LaterLeaf first, second;
  ArchiveReader("FILE", old_file, new_kind).read("oak", first, second);
  EXPECT_EQ(second.leaf.numbers, (std::vector<std::uint16_t>{5}));
  EXPECT_EQ(first.veins, 3);
  EXPECT_EQ(second.veins, 3);
  ArchiveReader("FILE", new_file, new_kind).read("oak", first, second);
  EXPECT_EQ(first.veins, 7);
  EXPECT_EQ(second.veins, 8);
  EXPECT_EQ(least_bytes<LaterLeaf>(), least_bytes<Leaf>());
}

}  // namespace
}  // namespace vsgraphs
