#include "igtl/fault.hpp"

namespace interlock::igtl {

std::string_view fault_text(Fault fault) noexcept {
  switch (fault) {
    case Fault::version:
      return "unknown header version; expected 1 or 2";
    case Fault::type_name:
      return "the type name is not printable ASCII, padded with zeros";
    case Fault::device_name:
      return "the device name is not printable ASCII, padded with zeros";
    case Fault::too_large:
      return "the body is larger than its type may be";
    case Fault::unknown_type:
      return "this type of message is not understood";
    case Fault::wrong_size:
      return "the body has a size that its type cannot have";
    case Fault::checksum:
      return "the CRC does not match the body";
    case Fault::extended_header:
      return "the extended header does not fit the body";
    case Fault::metadata:
      return "the lengths of the metadata do not add up";
    case Fault::inner_length:
      return "a length inside of the body does not fit the body";
    case Fault::not_finite:
      return "a number is not finite";
    case Fault::text:
      return "a text is unterminated, of an unknown encoding or not printable";
    case Fault::element_type:
      return "the array is not of float32 or float64";
    case Fault::late:
      return "the message did not end in time";
  }
  return "";
}

StatusCode status_of(Fault fault) noexcept {
  switch (fault) {
    case Fault::version:
      return StatusCode::unknown_version;
    case Fault::checksum:
      return StatusCode::checksum;
    case Fault::unknown_type:
      return StatusCode::unknown_instruction;
    case Fault::late:
      return StatusCode::timeout;
    case Fault::type_name:
    case Fault::device_name:
    case Fault::too_large:
    case Fault::wrong_size:
    case Fault::extended_header:
    case Fault::metadata:
    case Fault::inner_length:
    case Fault::not_finite:
    case Fault::text:
    case Fault::element_type:
      break;
  }
  return StatusCode::configuration;
}

}  // namespace interlock::igtl
