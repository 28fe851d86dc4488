"""Infrastructure of the tests: databases, servers, browsers, and the stages of `./run test`."""
