/** Any bytes as a stream of OpenIGTLink: the same comes of them however they are split, and whatever is read
 * can be judged. */
#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "igtl/codec.hpp"
#include "igtl/crc64.hpp"
#include "igtl/dialect.hpp"

namespace {

using namespace interlock::igtl;

struct Seen {
  std::vector<Header> headers;
  std::vector<Fault> faults;
  std::vector<std::string> answers; /**< names of what every dialect answers */

  bool operator==(const Seen&) const = default;
};

/** One connection in each dialect, whose controller it is; every command is granted. */
struct Talks {
  std::array<std::unique_ptr<Dialect>, 3> dialects{make_dialect("thesis"), make_dialect("brp2013"),
                                                   make_dialect("wpi2024")};

  void take(Seen& seen, const Message& message) {
    const RobotState state;
    for (const auto& dialect : dialects) {
      Reaction reaction = dialect->take(message, state, true);
      note_answers(seen, reaction);
      for (int follow_up = 0; reaction.command && follow_up < 3; ++follow_up) {
        Outcome outcome{{StatusCode::ok, 0, "OK", ""}};
        outcome.target = Transform{}.matrix;
        reaction = dialect->finish(message.device, *reaction.command, outcome);
        note_answers(seen, reaction);
      }
    }
  }

  static void note_answers(Seen& seen, const Reaction& reaction) {
    for (const auto& [name, body] : reaction.replies) {
      seen.answers.push_back(name);
      if (name.size() > device_width) {
        std::abort();
      }
    }
  }
};

void note(Seen& seen, Talks& talks, Arrival arrival) {
  if (auto* frame = std::get_if<Frame>(&arrival)) {
    seen.headers.push_back(frame->header);
    if (const auto message = decode(std::move(*frame))) {
      talks.take(seen, *message);
    } else {
      seen.faults.push_back(message.error());
    }
  } else if (const auto* refused = std::get_if<Refused>(&arrival)) {
    seen.headers.push_back(refused->header);
    seen.faults.push_back(refused->fault);
  }
}

Seen read_in_pieces(Bytes input, std::size_t piece) {
  Seen seen;
  FrameReader reader;
  Talks talks;
  while (!input.empty()) {
    Bytes some = input.first(std::min(piece, input.size()));
    input = input.subspan(some.size());
    while (!some.empty()) {
      Arrival arrival = reader.take(some);
      if (const auto* broken = std::get_if<Broken>(&arrival)) {
        seen.faults.push_back(broken->fault);
        return seen;
      }
      note(seen, talks, std::move(arrival));
    }
  }
  return seen;
}

constexpr std::size_t size_at = 42;
constexpr std::size_t crc_at = 50;
constexpr unsigned left_alone = 8;

void write_number(std::uint8_t* to, std::uint64_t number) {
  for (int byte = 7; byte >= 0; --byte, number >>= 8u) {
    to[byte] = static_cast<std::uint8_t>(number);
  }
}

/** Makes every body end where its header says, and gives it its checksum. */
void mend(std::uint8_t* data, std::size_t size) {
  for (std::size_t at = 0; at + header_bytes <= size;) {
    const std::size_t left = size - at - header_bytes;
    const auto told = read_number<std::uint64_t>(Bytes(data + at, header_bytes), size_at);
    const auto body = static_cast<std::size_t>(std::min<std::uint64_t>(told, left));
    write_number(data + at + size_at, body);
    write_number(data + at + crc_at, crc64(Bytes(data + at + header_bytes, body)));
    at += header_bytes + body;
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

/** A checksum stops nearly all that was changed by chance, so most of it is mended: decoders come behind. */
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  const std::size_t changed = LLVMFuzzerMutate(data, size, most);
  if (seed % left_alone != 0) {
    mend(data, changed);
  }
  return changed;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes input(data, size);
  if (!(read_in_pieces(input, std::max<std::size_t>(size, 1)) == read_in_pieces(input, 7))) {
    std::abort();
  }
  return 0;
}
