#include "recorder/ring.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

namespace interlock::recorder {
namespace {

std::uint32_t acquired(const std::uint32_t& word) { return __atomic_load_n(&word, __ATOMIC_ACQUIRE); }

std::uint32_t relaxed(const std::uint32_t& word) { return __atomic_load_n(&word, __ATOMIC_RELAXED); }

const std::uint32_t* payload_of(const ilk_block_header_t* block) {
  return reinterpret_cast<const std::uint32_t*>(block + 1);
}

/** Words before a field of the record of a tick. */
constexpr std::uint32_t tick_word = offsetof(ilk_tick_record_t, tick) / sizeof(std::uint32_t);
constexpr std::uint32_t alarm_word = offsetof(ilk_tick_record_t, alarm) / sizeof(std::uint32_t);
constexpr std::uint32_t state_tick_word = offsetof(ilk_state_t, system.tick) / sizeof(std::uint32_t);

/** A kernel answers at once, unless it was stopped by a signal. */
constexpr timeval longest_answer{0, 500'000};

constexpr int fixed_and_read_only = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE;

bool is_ring(const ilk_ring_header_t& header, std::size_t bytes) {
  return acquired(header.magic) == ILK_RING_MAGIC &&
         bytes == ILK_RING_HEADER_BYTES + std::size_t{header.blocks} * ILK_BLOCK_BYTES;
}

bool is_of_this_release(const ilk_run_description_t& run) {
  return run.version == ILK_RECORDING_VERSION && run.frame_words == ILK_FRAME_WORDS &&
         run.layout_hash == ilk_recording_layout_hash();
}

/** Descriptors that came with a message. */
using Received = std::array<FileDescriptor, 2>;

FileDescriptor connected(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  FileDescriptor socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &longest_answer, sizeof longest_answer);
  setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &longest_answer, sizeof longest_answer);
  if (path.native().size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return {};
  }
  std::ranges::copy(path.native(), address.sun_path);
  return socket && ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0
             ? std::move(socket)
             : FileDescriptor();
}

/** Both descriptors, or none. */
Received received(int socket) {
  std::uint32_t magic = 0;
  iovec body{&magic, sizeof magic};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(2 * sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &body;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t length = recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  const cmsghdr* const header = length < 0 ? nullptr : CMSG_FIRSTHDR(&message);
  if (header == nullptr || header->cmsg_type != SCM_RIGHTS) {
    return {};
  }
  std::array<int, 2> numbers{-1, -1};
  std::memcpy(numbers.data(), CMSG_DATA(header), std::min(header->cmsg_len - CMSG_LEN(0), sizeof numbers));
  return {FileDescriptor(numbers[0]), FileDescriptor(numbers[1])};
}

}  // namespace

Recorded<Ring> Ring::connect(const std::filesystem::path& path) {
  const std::string name = "black box " + path.string();
  const FileDescriptor socket = connected(path);
  if (!socket) {
    return failed_with(name, errno);
  }
  Received both = received(socket.get());
  if (!both[0] || !both[1]) {
    return tl::unexpected(name + ": the kernel does not hand it out; it may be stopped");
  }
  return map(std::move(both[0]), std::move(both[1])).map_error([&](const std::string& reason) {
    return name + ": " + reason;
  });
}

Recorded<Ring> Ring::map(FileDescriptor memory, FileDescriptor life) {
  struct stat status{};
  if (fstat(memory.get(), &status) != 0) {
    return failed_with("its memory", errno);
  }
  const auto bytes = static_cast<std::size_t>(status.st_size);
  // Whoever could shrink it could end its readers.
  const int seals = fcntl(memory.get(), F_GET_SEALS);
  if (status.st_uid != geteuid() || bytes < ILK_RING_HEADER_BYTES || seals < 0 ||
      (seals & fixed_and_read_only) != fixed_and_read_only) {
    return tl::unexpected(std::string("not of one of this user's kernels"));
  }
  void* const address = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, memory.get(), 0);
  if (address == MAP_FAILED) {
    return failed_with("its memory", errno);
  }
  Ring ring(std::move(life), static_cast<const ilk_ring_header_t*>(address), bytes);
  if (!is_ring(*ring.header_, bytes)) {
    return tl::unexpected(std::string("not complete"));
  }
  if (!is_of_this_release(ring.run())) {
    return tl::unexpected(std::string("written by a kernel of another release"));
  }
  return ring;
}

Ring::Ring(Ring&& other) noexcept
    : life_(std::move(other.life_)), header_(std::exchange(other.header_, nullptr)), bytes_(other.bytes_) {}

Ring::~Ring() {
  if (header_ != nullptr) {
    munmap(const_cast<ilk_ring_header_t*>(header_), bytes_);
  }
}

std::uint32_t Ring::head() const { return acquired(header_->head); }

std::uint32_t Ring::oldest() const {
  const std::uint32_t newest = head();
  return newest + 2 > header_->blocks ? newest + 2 - header_->blocks : std::min(newest, 1U);
}

bool Ring::closed() const { return acquired(header_->closed) != 0; }

bool Ring::writer_lives() const {
  pollfd end{life_.get(), 0, 0};
  return poll(&end, 1, 0) == 0;
}

std::optional<double> Ring::fewest_seconds() const {
  const std::uint32_t ticks = relaxed(header_->fewest_ticks);
  return ticks == 0 ? std::nullopt : std::optional(ticks * (run().config.common.period_us / 1e6));
}

const ilk_block_header_t* Ring::block(std::uint32_t number) const {
  const auto* const blocks = reinterpret_cast<const std::byte*>(header_) + ILK_RING_HEADER_BYTES;
  return reinterpret_cast<const ilk_block_header_t*>(blocks +
                                                     std::size_t{number % header_->blocks} * ILK_BLOCK_BYTES);
}

std::optional<std::uint32_t> Ring::used(std::uint32_t number) const {
  if (number == 0 || acquired(block(number)->number) != number) {
    return std::nullopt;
  }
  const std::uint32_t words = acquired(block(number)->used);
  return words >= ILK_OPENING_WORDS && words <= ILK_PAYLOAD_WORDS_MAX ? std::optional(words) : std::nullopt;
}

bool Ring::still_holds(std::uint32_t number) const {
  __atomic_thread_fence(__ATOMIC_ACQUIRE);
  return relaxed(block(number)->number) == number;
}

std::optional<BlockCopy> Ring::copy(std::uint32_t number) const {
  const std::optional<std::uint32_t> words = used(number);
  if (!words) {
    return std::nullopt;
  }
  BlockCopy copied{number, std::vector<std::uint32_t>(*words)};
  const std::uint32_t* const payload = payload_of(block(number));
  for (std::uint32_t i = 0; i < *words; ++i) {
    copied.payload[i] = relaxed(payload[i]);
  }
  return still_holds(number) ? std::optional(std::move(copied)) : std::nullopt;
}

std::optional<std::uint32_t> Ring::opening_tick(std::uint32_t number) const {
  if (!used(number)) {
    return std::nullopt;
  }
  const std::uint32_t tick = relaxed(payload_of(block(number))[state_tick_word]);
  return still_holds(number) ? std::optional(tick) : std::nullopt;
}

std::uint32_t Ring::block_before(std::uint32_t tick, std::uint32_t seconds) const {
  const auto ticks =
      static_cast<std::int32_t>(std::uint64_t{seconds} * 1'000'000 / run().config.common.period_us);
  const std::uint32_t first = oldest();
  std::uint32_t number = head();
  while (number > first) {
    const std::optional<std::uint32_t> opening = opening_tick(number);
    if (opening && static_cast<std::int32_t>(tick - *opening) >= ticks) {
      break;
    }
    --number;
  }
  return number;
}

std::optional<TickHead> Ring::next(RingPlace& place) const {
  for (;;) {
    // Before the words: a block that is no longer the head has got all of them.
    const std::uint32_t newest = head();
    const std::optional<std::uint32_t> words = used(place.block);
    if (!words) {
      const std::uint32_t first = oldest();
      if (first == 0 || first == place.block) {
        return std::nullopt;
      }
      place = {first, ILK_OPENING_WORDS};
      continue;
    }
    if (place.word >= *words) {
      if (place.block == newest) {
        return std::nullopt;
      }
      place = {place.block + 1, ILK_OPENING_WORDS};
      continue;
    }
    const std::uint32_t* const record = payload_of(block(place.block)) + place.word;
    const TickHead found{relaxed(record[tick_word]), relaxed(record[alarm_word])};
    const std::uint32_t length = relaxed(record[0]);
    if (still_holds(place.block) && length != 0) {
      place.word += length;
      return found;
    }
    place.block = 0;
  }
}

}  // namespace interlock::recorder
