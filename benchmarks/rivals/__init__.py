"""Other ways to find the path of a part, and how they are compared with this project's."""
