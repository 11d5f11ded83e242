"""Views: animations, pictures and pages of results."""
