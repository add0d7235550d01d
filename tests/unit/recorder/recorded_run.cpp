#include "recorded_run.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <numeric>
#include <span>
#include <stdexcept>

namespace interlock::recorder_test {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "ilk-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot create a temporary directory");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() { std::filesystem::remove_all(path_); }

void create_box(ilk_black_box_t& box, const ilk_config_t& config, std::uint32_t seconds) {
  const ilk_black_box_terms_t terms{&config, ILK_CLOCK_SIM, true, seconds};
  ilk_error_t error{};
  if (!ilk_black_box_create(&box, &terms, &error)) {
    throw std::runtime_error(error.text);
  }
}

recorder::Ring ring_of(const ilk_black_box_t& box) {
  recorder::Recorded<recorder::Ring> ring =
      recorder::Ring::map(FileDescriptor(dup(box.memory)), FileDescriptor(dup(box.life[0])));
  return ring ? std::move(*ring) : throw std::runtime_error(ring.error());
}

ilk_replay_report_t replayed(const std::filesystem::path& path) {
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  const auto recording = std::make_unique<ilk_recording_t>();
  if (!file || ilk_recording_begin(recording.get(), file.get()) != ILK_HEADER_GOOD) {
    throw std::runtime_error(path.string() + " is no recording");
  }
  ilk_replay_report_t report{};
  ilk_replay_recording(recording.get(), &report, nullptr, nullptr);
  return report;
}

RecordedRun::RecordedRun(std::uint32_t seed, std::uint32_t seconds) {
  world_config(&config_);
  world_begin(&world_, seed);
  ilk_init(&config_, &state_);
  create_box(box_, config_, seconds);
  ilk_black_box_begin(&box_, &state_);
}

RecordedRun::~RecordedRun() {
  if (open_) {
    close();
  }
}

void RecordedRun::close() {
  ilk_black_box_close(&box_);
  open_ = false;
}

void RecordedRun::die() {
  munmap(box_.blocks, box_.bytes - ILK_RING_HEADER_BYTES);
  munmap(box_.ring, ILK_RING_HEADER_BYTES);
  for (const int descriptor : {box_.memory, box_.life[0], box_.life[1]}) {
    ::close(descriptor);
  }
  open_ = false;
}

void RecordedRun::step(const std::function<void(const KnownTick&)>& watch) {
  const auto count = static_cast<std::uint32_t>(requests_.size());
  const std::uint64_t begun_ns = 1'000'000'000 + std::uint64_t{state_.system.tick} * 1'000'000;
  ilk_step(&config_, &state_, &in_, requests_.data(), count, &out_);
  ilk_black_box_note(&box_, begun_ns, &state_, &in_, requests_.data(), count, &out_);
  if (watch) {
    watch({{state_, in_, out_}, requests_, begun_ns});
  }
  requests_.clear();
}

void RecordedRun::run(std::uint32_t ticks, const std::function<void(const KnownTick&)>& watch) {
  for (std::uint32_t n = 0; n < ticks; ++n) {
    world_inputs(&world_, &config_, &state_, &out_, &in_);
    requests_.resize(ILK_REQUESTS_PER_TICK);
    requests_.resize(world_requests(&world_, &config_, &state_, requests_.data()));
    step(watch);
  }
}

void RecordedRun::calm_inputs() {
  in_.link_generation = 1;
  in_.deadlines_missed = 0;
  in_.transaction_done = 1;
  in_.frames_received = UINT32_MAX;
  in_.pedal_no_closed = 0;
  in_.pedal_nc_closed = 1;
  in_.estop_loop_closed = 1;
  world_.heartbeat += 1;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    const std::span frame(in_.frame[slot]);
    std::ranges::fill(frame, 0);
    frame[0] = 0xfefefe01;
    frame[2] = 0x00080000;
    frame[3] = counter_[slot];
    frame[9] = world_.heartbeat;
    frame[10] = state_.system.tick * 1000;
    frame[11] = state_.system.tick - 2;
    frame.back() = 0xffffffff - std::accumulate(frame.begin(), frame.end() - 1, 0U);
  }
}

void RecordedRun::put_request(ilk_request_kind_t kind, std::uint32_t axis) {
  ilk_request_t request{};
  request.sequence = ++world_.sequence;
  request.kind = kind;
  request.axis = axis;
  request.holder = 1;
  request.crc = ilk_request_crc(&request);
  requests_.push_back(request);
}

void RecordedRun::calm(std::uint32_t ticks) {
  for (std::uint32_t n = 0; n < ticks; ++n) {
    calm_inputs();
    put_request(ILK_REQUEST_HEARTBEAT, 0);
    step();
  }
}

void RecordedRun::ask(ilk_request_kind_t kind, std::uint32_t axis) {
  calm_inputs();
  put_request(ILK_REQUEST_HEARTBEAT, 0);
  put_request(kind, axis);
  step();
}

void RecordedRun::press_estop() {
  calm_inputs();
  in_.estop_loop_closed = 0;
  step();
}

void RecordedRun::make_jump(std::uint32_t axis) {
  counter_[axis] += 100;
  calm(1);
}

}  // namespace interlock::recorder_test
