// What holds for every request: one verdict each, the common checks and their order, inert refusals.
#include <gtest/gtest.h>

#include <vector>

#include "inert.hpp"

namespace interlock::kernel_test {
namespace {

Bench quiet_bench_in_motion() { return motion_bench(slot::pwm_free); }

TEST(P11_inert_refusal, the_first_failing_check_is_the_verdict) {
  Bench bench = quiet_bench_in_motion();
  bench.app_alive = false;
  ilk_request_t request = move(ILK_SLOTS, 5000, 5000, 5000);
  request.kind = 99;
  request.sequence = bench.last_sequence;
  request.crc = with_crc(request).crc ^ 1u;
  const auto judge = [&bench](const ilk_request_t& record) {
    bench.queue_record(record);
    bench.tick();
    return bench.verdict(0);
  };
  EXPECT_EQ(judge(request), ILK_VERDICT_CHECKSUM);
  EXPECT_EQ(judge(with_crc(request)), ILK_VERDICT_SEQUENCE);
  request.sequence = ++bench.last_sequence;
  EXPECT_EQ(judge(with_crc(request)), ILK_VERDICT_UNKNOWN);
  request.sequence = ++bench.last_sequence;
  request.kind = ILK_REQUEST_MOVE;
  EXPECT_EQ(judge(with_crc(request)), ILK_VERDICT_AXIS);
}

TEST(P11_inert_refusal, any_wrong_bit_of_a_request_is_CHECKSUM) {
  Bench bench = quiet_bench_in_motion();
  bench.app_alive = false;
  ilk_request_t right = move(slot::pwm_free, 50);
  right.sequence = bench.last_sequence + 1;
  right.consent = bench.system().consent;
  right = with_crc(right);
  for (uint32_t bit = 0; bit < sizeof(ilk_request_t) * 8; ++bit) {
    auto words = std::bit_cast<std::array<uint32_t, sizeof(ilk_request_t) / 4>>(right);
    words[bit / 32] ^= 1u << bit % 32;
    Bench trial = bench;
    trial.queue_record(std::bit_cast<ilk_request_t>(words));
    trial.tick();
    ASSERT_EQ(trial.out().verdict[0].verdict, uint32_t{ILK_VERDICT_CHECKSUM}) << bit;
    ASSERT_TRUE(trial.wire_is_zero());
    ASSERT_EQ(trial.system().last_sequence, bench.system().last_sequence);
  }
  bench.queue_record(right);
  bench.tick();
  EXPECT_EQ(bench.verdict(0), ILK_VERDICT_ACCEPTED);
}

TEST(P11_inert_refusal, a_wrong_CRC_changes_nothing) {
  Bench bench = quiet_bench_in_motion();
  Bench undisturbed = bench;
  undisturbed.tick();
  ilk_request_t request = disable(slot::pwm_free);
  request.sequence = bench.last_sequence + 1;
  bench.queue_record(request);
  bench.tick();
  EXPECT_EQ(bench.verdict(0), ILK_VERDICT_CHECKSUM);
  EXPECT_EQ(state_without_counters(bench), state_without_counters(undisturbed));
  EXPECT_EQ(bench.system().requests_refused, undisturbed.system().requests_refused + 1);
}

TEST(Sequence, must_be_newer_by_one_to_half_the_range) {
  const auto verdict_at = [](uint32_t distance) {
    Bench bench = quiet_bench_in_motion();
    bench.app_alive = false;
    ilk_request_t request = stop();
    request.sequence = bench.system().last_sequence + distance;
    bench.queue_record(with_crc(request));
    bench.tick();
    return bench.verdict(0);
  };
  EXPECT_EQ(verdict_at(0), ILK_VERDICT_SEQUENCE);
  EXPECT_EQ(verdict_at(1), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(verdict_at(1000), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(verdict_at(0x7FFFFFFFu), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(verdict_at(0x80000000u), ILK_VERDICT_SEQUENCE);
  EXPECT_EQ(verdict_at(0xFFFFFFFFu), ILK_VERDICT_SEQUENCE);
}

TEST(Sequence, starts_at_one) {
  Bench bench;
  bench.app_alive = false;
  ilk_request_t request = stop();
  bench.queue_record(with_crc(request));
  bench.tick();
  EXPECT_EQ(bench.verdict(0), ILK_VERDICT_SEQUENCE);
  request.sequence = 1;
  bench.queue_record(with_crc(request));
  bench.tick();
  EXPECT_EQ(bench.verdict(0), ILK_VERDICT_ACCEPTED);
}

TEST(Sequence, wraps) {
  Bench bench;
  bench.ticks(3);
  bench.app_alive = false;
  bench.last_sequence = 0x70000000u;
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  bench.last_sequence = 0xE0000000u;
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  bench.last_sequence = 0xFFFFFFFEu;
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.system().last_sequence, 1u);
}

TEST(Sequence, a_repeated_record_is_refused_and_does_not_reopen_older_numbers) {
  Bench bench = quiet_bench_in_motion();
  bench.app_alive = false;
  ilk_request_t request = move(slot::pwm_free, 50);
  request.sequence = bench.last_sequence + 5;
  request.consent = bench.system().consent;
  const ilk_request_t newest = with_crc(request);
  request.sequence -= 3;
  const ilk_request_t older = with_crc(request);
  request.sequence += 1;
  const ilk_request_t next_older = with_crc(request);
  bench.queue_record(newest);
  bench.queue_record(newest);
  bench.queue_record(older);
  bench.queue_record(next_older);
  bench.tick();
  EXPECT_EQ(bench.verdict(0), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.verdict(1), ILK_VERDICT_SEQUENCE);
  EXPECT_EQ(bench.verdict(2), ILK_VERDICT_SEQUENCE);
  EXPECT_EQ(bench.verdict(3), ILK_VERDICT_SEQUENCE);
  EXPECT_EQ(bench.system().last_sequence, newest.sequence);
}

TEST(Sequence, a_refused_request_uses_up_its_number) {
  Bench bench;
  bench.to_ready();
  bench.app_alive = false;
  const ilk_verdict_t verdict = bench.ask(reset());
  ASSERT_EQ(verdict, ILK_VERDICT_MODE);
  EXPECT_EQ(bench.system().last_sequence, bench.last_sequence);
}

TEST(Sequence, restarts_with_a_new_attachment) {
  Bench bench;
  bench.to_ready();
  bench.link_generation = 7;
  bench.last_sequence = 0;
  EXPECT_EQ(bench.ask(enable(slot::pwm_free)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.system().link_generation, 7u);
}

TEST(Common_checks, unknown_kinds_are_UNKNOWN) {
  Bench bench = quiet_bench_in_motion();
  for (const uint32_t kind : {0u, 11u, 255u, 0x80000001u, 0xFFFFFFFFu}) {
    ilk_request_t request = move(slot::pwm_free, 50);
    request.kind = kind;
    expect_refused(bench, request, ILK_VERDICT_UNKNOWN);
  }
}

TEST(Common_checks, a_slot_without_an_axis_is_AXIS_for_every_request_that_names_one) {
  Bench bench = quiet_bench_in_motion();
  for (uint32_t kind = ILK_REQUEST_DISABLE; kind <= ILK_REQUEST_RESTORE; ++kind) {
    for (const uint32_t axis : {slot::sensor, slot::empty, uint32_t{ILK_SLOTS}, 0x80000000u, 0xFFFFFFFFu}) {
      ilk_request_t request = move(axis, 50);
      request.kind = kind;
      expect_refused(bench, request, ILK_VERDICT_AXIS);
    }
  }
}

TEST(Common_checks, requests_without_an_axis_ignore_that_field) {
  Bench bench;
  bench.ticks(5);
  for (const uint32_t kind :
       {uint32_t{ILK_REQUEST_HEARTBEAT}, uint32_t{ILK_REQUEST_STOP}, uint32_t{ILK_REQUEST_RESET}}) {
    ilk_request_t request = heartbeat(1);
    request.kind = kind;
    request.axis = 0xFFFFFFFFu;
    EXPECT_EQ(bench.ask(request), ILK_VERDICT_ACCEPTED) << kind;
  }
}

TEST(P11_inert_refusal, at_most_sixteen_requests_are_judged_in_a_tick) {
  Bench bench;
  bench.to_ready();
  bench.app_alive = false;
  for (int more = 0; more < 20; ++more) bench.queue(stop());
  bench.tick();
  EXPECT_EQ(bench.out().verdict_count, uint32_t{ILK_REQUESTS_PER_TICK});
  EXPECT_EQ(bench.system().last_sequence, bench.last_sequence - 4);
}

TEST(P11_inert_refusal, verdicts_come_in_order_and_name_their_request) {
  Bench bench;
  bench.to_ready();
  bench.app_alive = false;
  const std::vector<ilk_request_t> requests = {enable(slot::pwm_free), move(slot::pwm_free, 10), reset(),
                                               disable(slot::empty), stop()};
  const std::vector<ilk_verdict_t> verdicts = {ILK_VERDICT_ACCEPTED, ILK_VERDICT_MODE, ILK_VERDICT_MODE,
                                               ILK_VERDICT_AXIS, ILK_VERDICT_ACCEPTED};
  const uint32_t first = bench.last_sequence + 1;
  const uint32_t accepted = bench.system().requests_accepted;
  const uint32_t refused = bench.system().requests_refused;
  for (const ilk_request_t& request : requests) bench.queue(request);
  bench.tick();
  ASSERT_EQ(bench.out().verdict_count, requests.size());
  for (uint32_t index = 0; index < requests.size(); ++index) {
    const ilk_verdict_record_t& record = bench.out().verdict[index];
    EXPECT_EQ(record.verdict, uint32_t{verdicts[index]});
    EXPECT_EQ(record.sequence, first + index);
    EXPECT_EQ(record.kind, requests[index].kind);
    EXPECT_EQ(record.axis, requests[index].axis);
    EXPECT_EQ(record.tick, bench.now());
  }
  EXPECT_EQ(bench.system().requests_accepted, accepted + 2);
  EXPECT_EQ(bench.system().requests_refused, refused + 3);
}

TEST(P11_inert_refusal, the_request_crc_is_the_standard_one) {
  ilk_request_t request = move(3, -77, 123, 9);
  request.sequence = 0x01020304u;
  request.consent = 0x5A5A5A5Au;
  request.holder = 0xA5A5A5A5u;
  EXPECT_EQ(ilk_request_crc(&request), with_crc(request).crc);
  EXPECT_EQ(crc32_of_words(std::array<uint32_t, 2>{0x34333231u, 0x38373635u}), 0x9AE0DAAFu)
      << "CRC-32 of \"12345678\"";
}

TEST(Ordering, requests_of_one_tick_act_in_order) {
  Bench bench;
  bench.to_motion();
  bench.rest();
  const uint32_t too_early = bench.queue(move(slot::pwm_free, 50));
  bench.queue(enable(slot::pwm_free));
  const uint32_t in_time = bench.queue(move(slot::pwm_free, 50));
  bench.tick();
  EXPECT_EQ(bench.verdict_of(too_early), ILK_VERDICT_DISABLED);
  EXPECT_EQ(bench.verdict_of(in_time), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(slot::pwm_free));
  const uint32_t halt = bench.queue(stop());
  const uint32_t too_late = bench.queue(move(slot::pwm_free, 50));
  bench.tick();
  EXPECT_EQ(bench.verdict_of(halt), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.verdict_of(too_late), ILK_VERDICT_MODE);
}

TEST(Ordering, a_request_is_judged_by_the_frames_of_its_own_tick) {
  Bench bench = quiet_bench_in_motion();
  bench.motor[slot::pwm_free].travelled += 100;
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 50)), ILK_VERDICT_MODE) << "the jump ended MOTION before";
  EXPECT_EQ(bench.axis_state(slot::pwm_free), ILK_AXIS_FAULTED);
}

}  // namespace
}  // namespace interlock::kernel_test
