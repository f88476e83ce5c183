//! What a file may call its neighbours: which URIs are followed, and to where.
