"""The compiled engines: private, reached through `tribodyn.dynamics.time`."""
