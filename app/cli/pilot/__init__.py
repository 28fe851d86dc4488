"""The command `reembody pilot`: what a planned study would find, and whether it can be run."""
