/** Whole ticks, judged by the monitors. */
void harness(void) {}
