from .animation import animate as animate
