"""Large deflection: von Karman's plate, which stretches as it bends."""
