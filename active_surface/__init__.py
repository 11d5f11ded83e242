"""active-surface: simulate active surfaces, thin plates on point actuators that move micron-sized parts."""
