/**
 * @file
 * The checks that a proposal meets, by name and in their order, and what each found. The first that fails is
 * the refusal; what would come after it is not looked at.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace interlock {

/** Why a request is not granted, and what to do about it. */
struct Refusal {
  std::string code;   /**< verdict of the catalog, or a code of spec/openapi.yaml */
  std::string detail; /**< what, where */
  std::string expected;
  std::string next_step;

  bool operator==(const Refusal&) const = default;
};

/** What a check looks at. */
enum class CheckName : std::uint8_t {
  other_motion,
  targeting,
  configuration,
  mode,
  axes,
  homed,
  drive,
  range,
  separation,
  rates,
  switches,
  home_order,
  band,
  force,
  skin,
  depth,
  instrument
};

/** As the interface spells it: "other_motion". */
std::string_view check_name(CheckName name) noexcept;

/** What holds when the check passes, as a sentence for people. */
std::string_view check_words(CheckName name) noexcept;

/** What became of a check. */
enum class CheckOutcome : std::uint8_t { passed, failed, not_reached };

/** As the interface spells it. */
constexpr std::string_view outcome_name(CheckOutcome outcome) noexcept {
  constexpr std::string_view names[] = {"passed", "failed", "not_reached"};
  return names[static_cast<std::size_t>(outcome)];
}

/** One check and what it found. */
struct CheckResult {
  CheckName name = CheckName::configuration;
  CheckOutcome outcome = CheckOutcome::not_reached;
  std::string code; /**< of the refusal; empty unless it failed */

  bool operator==(const CheckResult&) const = default;
};

/** The checks of one proposal as they are made. */
class CheckList {
 public:
  /** Makes a check, `look()` giving a `tl::expected<void, Refusal>`, unless one before it failed. */
  template <typename Look>
  void make(CheckName name, const Look& look) {
    if (refusal_) {
      results_.push_back({name, CheckOutcome::not_reached, ""});
      return;
    }
    tl::expected<void, Refusal> found = look();
    if (found) {
      results_.push_back({name, CheckOutcome::passed, ""});
      return;
    }
    refusal_ = std::move(found.error());
    results_.push_back({name, CheckOutcome::failed, refusal_->code});
  }

  /** Nothing when every check passed, else what the first that failed says. */
  [[nodiscard]] tl::expected<void, Refusal> outcome() const {
    return refusal_ ? tl::expected<void, Refusal>(tl::make_unexpected(*refusal_))
                    : tl::expected<void, Refusal>();
  }

  /** In the order in which they were asked for. */
  [[nodiscard]] const std::vector<CheckResult>& results() const { return results_; }

 private:
  std::vector<CheckResult> results_;
  std::optional<Refusal> refusal_;
};

}  // namespace interlock
