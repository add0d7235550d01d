/**
 * @file
 * From a message's body to bytes.
 */
#pragma once

#include "igtl/message.hpp"

namespace interlock::igtl {

/**
 * The content of a body, without header and without what version 2 adds. Texts are cut to what their fields
 * hold; an NDARRAY is of float64.
 *
 * Packed by Debian's libopenigtlink but for POINT, TDATA, SENSOR, NDARRAY and CAPABILITY (see
 * decode.hpp).
 */
ByteVector encode(const Body& body);

}  // namespace interlock::igtl
