"""The work behind `kinematify.generate`: an object is built, drawn by a model or made elsewhere, then validated."""
