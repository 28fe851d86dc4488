"""What tests stand on: databases, servers, browsers and the stages of `./run test`."""
