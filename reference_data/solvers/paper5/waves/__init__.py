"""Second variation of wrinkled states for a wave number."""
