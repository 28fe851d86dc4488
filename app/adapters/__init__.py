"""Read and write foreign file formats: motion captures, humanoid models, walking tracks."""
