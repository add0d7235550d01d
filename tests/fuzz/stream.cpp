/** Any bytes as a stream of OpenIGTLink: the same comes of them however they are split, and whatever is read
 * can be judged. */
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "igtl/decode.hpp"
#include "igtl/thesis.hpp"

namespace {

using namespace interlock::igtl;

struct Seen {
  std::vector<Header> headers;
  std::vector<Fault> faults;

  bool operator==(const Seen&) const = default;
};

void note(Seen& seen, Arrival arrival) {
  if (auto* frame = std::get_if<Frame>(&arrival)) {
    seen.headers.push_back(frame->header);
    if (const auto message = decode(std::move(*frame))) {
      (void)read_wish(*message);
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
  while (!input.empty()) {
    Bytes some = input.first(std::min(piece, input.size()));
    input = input.subspan(some.size());
    while (!some.empty()) {
      Arrival arrival = reader.take(some);
      if (const auto* broken = std::get_if<Broken>(&arrival)) {
        seen.faults.push_back(broken->fault);
        return seen;
      }
      note(seen, std::move(arrival));
    }
  }
  return seen;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes input(data, size);
  if (!(read_in_pieces(input, std::max<std::size_t>(size, 1)) == read_in_pieces(input, 7))) {
    std::abort();
  }
  return 0;
}
