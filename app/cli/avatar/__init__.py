"""The command `reembody avatar`: show, edit, compare, convert, save and load configurations."""
