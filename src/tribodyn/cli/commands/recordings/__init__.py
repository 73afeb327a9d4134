"""Commands that make recordings."""
