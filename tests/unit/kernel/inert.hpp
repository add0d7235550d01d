/// Property P11 as one check: a refused request leaves nothing behind but counters and its verdict.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>

#include "bench.hpp"

namespace interlock::kernel_test {

/// The state without what P11 calls counters, and without the seal that covers them.
inline auto state_without_counters(const Bench& bench) {
  ilk_state_t state = bench.state();
  state.system.last_sequence = 0;
  state.system.requests_accepted = 0;
  state.system.requests_refused = 0;
  state.seal = 0;
  return std::bit_cast<std::array<uint32_t, sizeof(ilk_state_t) / 4>>(state);
}

/// What a tick decided, apart from its verdicts.
inline auto decisions(const Bench& bench) {
  ilk_outputs_t out = bench.out();
  out.verdict_count = 0;
  for (auto& record : out.verdict) record = {};
  return std::bit_cast<std::array<uint32_t, sizeof(ilk_outputs_t) / 4>>(out);
}

/// Sends the request, expects that refusal, and that the tick was otherwise as if nothing had been sent.
inline void expect_refused(Bench& bench, const ilk_request_t& request, ilk_verdict_t verdict) {
  Bench undisturbed = bench;
  undisturbed.tick();
  EXPECT_EQ(bench.ask(request), verdict);
  EXPECT_EQ(bench.state().system.requests_refused, undisturbed.state().system.requests_refused + 1);
  EXPECT_EQ(state_without_counters(bench), state_without_counters(undisturbed)) << "P11: state changed";
  EXPECT_EQ(decisions(bench), decisions(undisturbed)) << "P11: outputs changed";
}

}  // namespace interlock::kernel_test
