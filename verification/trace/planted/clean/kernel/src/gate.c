/*@ requires readable: \valid_read(pedal);
  @ ensures  P1_gate: \result ==> *pedal;
  @*/
static bool may_drive(const bool* pedal) { return *pedal; }
