"""Small contact problems whose solution and contact set are proven by ball arithmetic, stored as JSON."""
