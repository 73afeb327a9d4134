"""Laws of one mean coefficient for a whole mesh, from its load and speeds at the pitch point."""
