"""A film of air under a part: it bears load, and decides with the asperities how wide the gap is."""

from particle.film.film import Film, assumed_contact
from particle.film.path import find_film_path
