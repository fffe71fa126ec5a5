"""One question each; `kinematify bench --list` names them."""
