/** The gate, for any pedal. */
