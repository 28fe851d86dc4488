"""From tracks and captures to walks."""
