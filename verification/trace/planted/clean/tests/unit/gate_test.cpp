#include <gtest/gtest.h>

TEST(P1_gate, needs_the_pedal) {}
TEST(Lamps, show_the_pedal) {}
