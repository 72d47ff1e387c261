// Empty: what this target is for are the headers that it precompiles for the others.
