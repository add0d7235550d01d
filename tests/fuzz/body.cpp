/** Any bytes as the content of a message of each type: whatever is understood says the same after it was
 * written and read again. The first byte chooses the type. */
#include <array>
#include <cstdlib>
#include <string_view>

#include "igtl/codec.hpp"
#include "igtl/thesis.hpp"

namespace {

using namespace interlock::igtl;

constexpr std::array<std::string_view, 13> types{
    "TRANSFORM", "STRING",    "STATUS",  "POINT",  "POSITION",   "TDATA",    "STT_TDATA",
    "STP_TDATA", "RTS_TDATA", "NDARRAY", "SENSOR", "CAPABILITY", "GET_TRANS"};

std::string_view type_of(std::uint8_t choice) { return types[choice % types.size()]; }

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

/** Cuts what was changed to a size that its type can have: other sizes never reach a decoder. */
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned /*seed*/) {
  const std::size_t changed = LLVMFuzzerMutate(data, size, most);
  for (std::size_t fitting = changed; fitting > 0; --fitting) {
    if (is_size_of(type_of(data[0]), fitting - 1)) {
      return fitting;
    }
  }
  return changed;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view type = type_of(data[0]);
  const ByteVector content(data + 1, data + size);
  if (!is_size_of(type, content.size())) {
    return 0;
  }
  const auto message = decode({{1, std::string(type), "", 0, content.size(), 0}, content, 0, {}});
  if (!message) {
    return 0;
  }
  (void)read_change(*message);
  const ByteVector written = encode(message->body);
  const auto again = decode({{1, std::string(type), "", 0, written.size(), 0}, written, 0, {}});
  if (!again || !(again->body == message->body)) {
    std::abort();
  }
  return 0;
}
