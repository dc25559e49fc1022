"""Commands of `python3 -m endovascular_sim.plots`: a module with add_arguments(parser) and run(options) each."""
