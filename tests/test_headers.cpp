// Nothing of its own: what its target has parsed is shared by the test programs.
