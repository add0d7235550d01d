#include "service/fields.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace interlock::web {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Fields, ANumberMayBeSentAsAStringThatHoldsOne) {
  const json body{{"a", "12.5"}, {"b", "-3"}, {"c", "1e3"}, {"d", "7.0"}};
  Fields fields(body, {"a", "b", "c", "d"});
  EXPECT_EQ(fields.number("a"), 12.5);
  EXPECT_EQ(fields.integer("b", -10, 10), -3);
  EXPECT_EQ(fields.number("c"), 1000.0);
  EXPECT_EQ(fields.integer("d", 0, 10), 7);
  EXPECT_FALSE(fields.problem());
}

TEST(Fields, AStringThatIsNotWhollyANumberIsRefused) {
  for (const char* text : {"", " 1", "1 ", "1,5", "+1", "0x10", "1e", "nan", "inf", "-inf", "1e999", ".5",
                           "5.", "1mm", "--1", "01", "true", "null", "[1]"}) {
    const json body{{"a", text}};
    Fields as_number(body, {"a"});
    EXPECT_FALSE(as_number.number("a")) << text;
    ASSERT_TRUE(as_number.problem()) << text;
    EXPECT_EQ(as_number.problem()->field, "a") << text;
    Fields as_integer(body, {"a"});
    EXPECT_FALSE(as_integer.integer("a", -100, 100)) << text;
    EXPECT_TRUE(as_integer.problem()) << text;
  }
}

TEST(Fields, AnIntegerHasABoundOnEachSide) {
  const json body{{"low", "-5"}, {"high", 5}, {"above", 6}};
  Fields fields(body, {"low", "high", "above"});
  EXPECT_EQ(fields.integer("low", -5, 5), -5);
  EXPECT_EQ(fields.integer("high", -5, 5), 5);
  EXPECT_FALSE(fields.problem());
  EXPECT_EQ(fields.integer("above", -5, 5), std::nullopt);
  EXPECT_EQ(fields.problem()->expected, "an integer from -5 to 5");
}

TEST(Fields, ANumberBeyondItsRangeIsRefusedWithTheRange) {
  const json body{{"a", 1000}, {"b", "1000.5"}};
  Fields fields(body, {"a", "b"});
  EXPECT_EQ(fields.number("a", -1000, 1000), 1000.0);
  EXPECT_EQ(fields.number("b", -1000, 1000), std::nullopt);
  EXPECT_EQ(fields.problem()->field, "b");
  EXPECT_EQ(fields.problem()->expected, "a number from -1000 to 1000");
}

TEST(Fields, AListOfNumbersNamesItsWrongElement) {
  const json body{{"good", {1, "2.5", 3}}, {"short", {1, 2}}, {"odd", {1, 2, nullptr}}};
  Fields good(body, {"good", "short", "odd"});
  EXPECT_THAT(good.numbers("good", 3).value_or(std::vector<double>{}), ElementsAre(1.0, 2.5, 3.0));
  EXPECT_FALSE(good.problem());
  Fields shorter(body, {"good", "short", "odd"});
  EXPECT_FALSE(shorter.numbers("short", 3));
  EXPECT_THAT(shorter.problem()->detail, HasSubstr("2 elements"));
  Fields odd(body, {"good", "short", "odd"});
  EXPECT_FALSE(odd.numbers("odd", 3));
  EXPECT_EQ(odd.problem()->field, "odd[2]");
}

TEST(Fields, AChoiceIsOneOfItsNames) {
  constexpr std::array<std::string_view, 2> levels{"debug", "info"};
  const json body{{"a", "info"}, {"b", "loud"}, {"c", 3}};
  Fields good(body, {"a", "b", "c"});
  EXPECT_EQ(good.choice("a", levels), "info");
  EXPECT_FALSE(good.problem());
  EXPECT_FALSE(good.choice("b", levels));
  EXPECT_EQ(good.problem()->expected, "one of debug, info");
  Fields wrong(body, {"a", "b", "c"});
  EXPECT_FALSE(wrong.choice("c", levels));
  EXPECT_EQ(wrong.problem()->field, "c");
}

TEST(Fields, BooleansAndTextsAreNothingElse) {
  const json body{{"yes", true}, {"name", "x"}};
  Fields fields(body, {"yes", "name"});
  EXPECT_EQ(fields.boolean("yes"), true);
  EXPECT_EQ(fields.text("name"), "x");
  EXPECT_EQ(fields.boolean("absent"), std::nullopt);
  EXPECT_FALSE(fields.problem());
  EXPECT_EQ(fields.boolean("name"), std::nullopt);
  EXPECT_EQ(fields.problem()->field, "name");
  Fields other(body, {"yes", "name"});
  EXPECT_EQ(other.text("yes"), std::nullopt);
  EXPECT_EQ(other.problem()->field, "yes");
}

TEST(Fields, AListOfTextsHasItsBounds) {
  const json body{{"good", {"a", "b"}}, {"empty", json::array()}, {"odd", {"a", 1}}};
  for (const std::string name : {"empty", "odd"}) {
    Fields fields(body, {"good", "empty", "odd"});
    EXPECT_FALSE(fields.texts(name, 1, 2)) << name;
    EXPECT_EQ(fields.problem()->field, name);
  }
  Fields fields(body, {"good", "empty", "odd"});
  EXPECT_THAT(*fields.texts("good", 1, 2), ElementsAre("a", "b"));
}

TEST(Fields, NullIsAnIntegerOnlyWhereThatIsSaid) {
  const json body{{"a", nullptr}};
  Fields fields(body, {"a"});
  EXPECT_EQ(fields.integer_or_null("a", 0, 1), std::nullopt);
  EXPECT_FALSE(fields.problem());
  EXPECT_EQ(fields.integer("a", 0, 1), std::nullopt);
  EXPECT_TRUE(fields.problem());
}

TEST(Fields, APlaceInsideOfTheBodyIsNamedWhole) {
  const json object{{"axis", 1}};
  Fields fields(object, {"axis"}, "file.axes[2]");
  EXPECT_FALSE(fields.text("axis"));
  EXPECT_EQ(fields.problem()->field, "file.axes[2].axis");
  const json number(7);
  Fields none(number, {"axis"}, "file.axes[3]");
  EXPECT_EQ(none.problem()->field, "file.axes[3]");
}

TEST(Fields, AMissingFieldIsNamedWithWhatBelongsThere) {
  const json body{{"a", 1}};
  Fields fields(body, {"a", "b"});
  fields.require({{"a", "a number"}, {"b", "a text"}});
  EXPECT_EQ(fields.problem()->field, "b");
  EXPECT_EQ(fields.problem()->expected, "a text");
}

}  // namespace
}  // namespace interlock::web
