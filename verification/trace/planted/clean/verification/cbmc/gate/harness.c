/** The gate, for any pedal. */
void harness(void) {}
