class Failure(Exception):
    """One plain sentence for the user: something is missing or cannot be used."""
