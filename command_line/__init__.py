"""The command `active-surface`: one module for each command or two, over all the packages."""
