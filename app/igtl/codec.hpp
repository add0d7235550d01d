/**
 * @file
 * Bodies of OpenIGTLink messages, to and from bytes.
 */
#pragma once

#include <tl/expected.hpp>

#include "igtl/message.hpp"

namespace interlock::igtl {

// From a frame to a message.
//
// Debian's libopenigtlink unpacks TRANSFORM, STRING, STT_TDATA and RTS_TDATA, once everything was checked
// here that it trusts: it reads beyond bodies whose inner lengths are wrong. Where no check makes it safe,
// the type is decoded here: POINT and TDATA, whose numbers it reads by pointers to odd addresses, which some
// processors refuse; POSITION, of which it swaps bytes behind the end of one without a rotation; SENSOR, as
// it swaps as many numbers as the body claims to have before it looks whether they are there; STATUS, whose
// length it takes for right; NDARRAY and CAPABILITY, as it never frees all of what it unpacked.

/** The message of a frame that a FrameReader gave. */
tl::expected<Message, FaultAt> decode(Frame frame);

// From a message's body to bytes.

/**
 * The content of a body, without header and without what version 2 adds. Texts are cut to what their fields
 * hold; an NDARRAY is of float64.
 *
 * Packed by Debian's libopenigtlink but for POINT, TDATA, SENSOR, NDARRAY and CAPABILITY (see
 * above).
 */
ByteVector encode(const Body& body);

}  // namespace interlock::igtl
