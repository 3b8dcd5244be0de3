"""How far the form of an effect differs from the machine's (model discrepancy), and where an effect lives."""
