/** P1: true while the pedal is pressed. */
static bool may_drive(const bool* pedal) { return *pedal; }
