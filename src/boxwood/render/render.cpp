namespace boxwood {}
