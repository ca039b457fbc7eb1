import java.io.BufferedReader;
import java.io.InputStreamReader;
import java.lang.management.ManagementFactory;
import java.lang.management.ThreadMXBean;
import java.lang.reflect.Method;
import java.nio.charset.StandardCharsets;
import java.util.Arrays;
import org.eclipse.core.runtime.IExtensionRegistry;
import org.eclipse.core.runtime.RegistryFactory;

/** Calls CIF's tools in one running Java: each line is the class of a tool and its arguments, with tabs between. */
public class Calls {
    public static void main(String[] none) throws Exception {
        // Outside of Eclipse nothing registers what annotations mean: CIF warns of each then, and reads on.
        IExtensionRegistry empty = RegistryFactory.createRegistry(null, null, null);
        RegistryFactory.setDefaultRegistryProvider(() -> empty);
        ThreadMXBean thread = ManagementFactory.getThreadMXBean();
        BufferedReader lines = new BufferedReader(new InputStreamReader(System.in, StandardCharsets.UTF_8));
        for (String line = lines.readLine(); line != null; line = lines.readLine()) {
            String[] parts = line.split("\t");
            Object tool = Class.forName(parts[0]).getConstructor().newInstance();
            Method run = tool.getClass().getMethod("run", String[].class, boolean.class);
            long began = System.nanoTime();
            long before = thread.getCurrentThreadCpuTime();
            Object status = run.invoke(tool, Arrays.copyOfRange(parts, 1, parts.length), false);
            long processor = thread.getCurrentThreadCpuTime() - before;
            long took = System.nanoTime() - began;
            System.out.println("called: " + status + " " + took / 1_000_000 + " " + processor / 1_000_000);
            System.out.flush();
        }
    }
}
